#include "core/error.h"

#include <utility>

namespace asdic {

InputError::InputError(InputFault fault)
    : std::runtime_error(fault.where + ": found " + fault.got + ", expected " + fault.expected),
      fault_(std::move(fault)) {}

InputError InputError::inside(const std::string& outer) const {
  InputFault fault = fault_;
  if (!outer.empty()) fault.where = fault.where.empty() ? outer : outer + "." + fault.where;
  return InputError(std::move(fault));
}

}  // namespace asdic
