#pragma once
#include <filesystem>
#include <string>

#include "app/output.h"
#include "io/result/result_json.h"

namespace asdic::detail::app {

[[nodiscard]] std::string rays_table(const RaysResult& result);
/// docs/formats/rays.md, or a .ray file, by the name's ending \throws RunError
void write_rays_file(OutputFile&& to, const RaysResult& result);

}  // namespace asdic::detail::app
