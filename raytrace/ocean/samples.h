#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace asdic::detail {

/// What every table of the ocean asks of its samples, in one order: enough of them, as many values
/// as places, and then sample by sample its place and its value. Each \throws InputError that names
/// what is at fault.

/// \param name  of the axis, as it is called in messages
void check_count(std::size_t count, const char* name, std::size_t least);

/// \param axis  that the values belong to, in the plural
void check_as_many(std::size_t values, const char* name, std::size_t places, const char* axis);

/// The i-th place on an axis: finite [m], and `beyond` ("a depth below") the one before.
/// \param steps  two places may be the same, as where a value jumps
void check_place(std::span<const double> axis, std::size_t i, const char* name, const char* beyond,
                 bool steps = false);

/// A speed of sound. \param where  it stands, as in "speed[3]"
void check_speed(double speed, const std::string& where);

}  // namespace asdic::detail
