#pragma once
#include "core/propagation_memory.h"
#include "core/settings_words.h"

namespace asdic::detail {

/// All that decides what a described struct does, in a key of what is remembered.
template <Described T>
void add_settings(ExactKey& key, const T& settings) {
  for (const std::uint64_t word : settings_words(settings)) key.add(word);
}

}  // namespace asdic::detail
