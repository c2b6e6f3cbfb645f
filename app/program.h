#pragma once
#include <span>

#include "app/command.h"

namespace asdic::app {

using AddCommand = void (*)(CLI::App& program, Action& action);

/// Parses the command line, does what it asks for, and says what went wrong. \return the exit
/// status
int run_program(int argc, char** argv, std::span<const AddCommand> commands);

}  // namespace asdic::app
