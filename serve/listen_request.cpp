#include "serve/listen_request.h"

#include "core/quantity.h"
#include "io/settings/reader.h"
#include "io/text/toml_table.h"
#include "serve/update.h"

namespace asdic::detail::serve {

void ListenRequest::describe(Fields& field) {
  field("block", block, {.noun = "duration", .unit = "s", .low = 1e-3, .high = 60.0},
        "of the samples that come together");
  field("seconds", seconds, {.noun = "duration", .unit = "s", .low = 1e-6, .high = 1e9},
        "of what is heard; default, by the clock alone: without end");
  field("schedule", schedule,
        "whether the pings of the scenario's schedule are sent by themselves");
  field("stop", stop, "whether no more comes");
  field("deliver", deliver,
        "where the samples go: to the client, or where the server sends streams");
}

SettingsList listen_settings() { return catalogue_of<ListenRequest>(); }

ListenRequest read_listen(const TomlValue& fields) {
  try {
    TomlTable reader(fields);
    ListenRequest request;
    KnownSettings known;
    TomlReader walker(reader, known);
    request.describe(walker);
    reader.finish();
    return request;
  } catch (const InputError& error) {
    throw refusal_of_value(error);
  }
}

}  // namespace asdic::detail::serve
