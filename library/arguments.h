#pragma once
#include <optional>
#include <string>

#include "core/quantity.h"

namespace asdic {

/// Hold an argument of a public function against what it must be. \throws InputError naming it
void require(const std::string& argument, double value, const detail::Quantity& must);
void require(const std::string& argument, const std::optional<double>& value,
             const detail::Quantity& must);
void require(const std::string& argument, int value, int low, int high);

}  // namespace asdic
