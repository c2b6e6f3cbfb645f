#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>

namespace asdic::detail::serve {

struct Answer;
struct SessionSettings;

/// Carries out again what a log of commands holds (serve/command_log.h), session by session in its
/// order; what had been refused is left out. What was heard between commands is heard again.
/// \param tell  gets what the clients got
/// \return commands that were refused this time
/// \throws InputError{where: "--replay"} if it is none, or one of another scenario
std::size_t replay(const SessionSettings& settings, const std::filesystem::path& log,
                   const std::function<void(const Answer&)>& tell);

}  // namespace asdic::detail::serve
