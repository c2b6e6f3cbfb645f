#include "core/error.h"

#include <utility>

#include "core/printable.h"

namespace asdic::detail {

// What it says is printable: control characters out of a file are escaped.
InputError::InputError(InputFault fault)
    : std::runtime_error(
          printable(fault.where + ": found " + fault.got + ", expected " + fault.expected)),
      fault_(std::move(fault)) {}

InputError InputError::inside(const std::string& outer) const {
  InputFault fault = fault_;
  if (!outer.empty()) fault.where = fault.where.empty() ? outer : outer + "." + fault.where;
  return InputError(std::move(fault));
}

}  // namespace asdic::detail
