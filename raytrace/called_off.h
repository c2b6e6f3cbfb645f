#pragma once

namespace asdic {

/// True in a task whose group was cancelled, such as a realisation in hand when a study is stopped
/// (study/run.h).
[[nodiscard]] bool called_off() noexcept;

/// Asked after every parallel loop (raytrace/parallel.h): one that is called off ends early,
/// without a word and with its results half made. \throws Interrupted
void leave_if_called_off();

}  // namespace asdic
