#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/error.h"

/// What libFuzzer calls, and replay.cpp where there is no libFuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace asdic::detail::fuzz {

inline std::string_view text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

inline std::string last_refusal;  ///< for the message of a law that does not hold

/// Does what may refuse its input, in words. Anything else that is thrown ends the program.
template <class Work>
bool refuses(Work work) {
  try {
    work();
    return false;
  } catch (const InputError& error) {
    last_refusal = error.what();
    if (last_refusal.empty()) std::abort();
    return true;
  }
}

/// A law that must hold. \throws nothing: the program ends
inline void insist(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s (%s)\n", law, last_refusal.c_str());
  std::abort();
}

}  // namespace asdic::detail::fuzz
