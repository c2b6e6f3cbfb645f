#pragma once
#include <cstdint>
#include <string>

/// Numbers as gfortran's list-directed WRITE prints them, each with the blank before it.
namespace asdic::detail::bellhop {

void append_real4(std::string& text, float value);           ///< 17 characters, 9 digits
void append_real8(std::string& text, double value);          ///< 26 characters, 17 digits
void append_integer(std::string& text, std::int64_t value);  ///< 12 characters

}  // namespace asdic::detail::bellhop
