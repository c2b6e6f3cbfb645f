#pragma once
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <utility>

#include "asdic/watch.h"
#include "library/access.h"
#include "raytrace/parallel/stop.h"

namespace asdic {

/// Work of the project's that can be called off. \return what it returns
template <class Work>
auto watched(const Watch& watch, const Work& work,
             std::initializer_list<std::filesystem::path> files = {}) {
  return translated(
      [&] {
        if (!watch.stop.stop_possible()) return work();
        std::optional<decltype(work())> result;
        detail::until_stopped(watch.stop, [&] { result.emplace(work()); });
        return std::move(*result);
      },
      files);
}

}  // namespace asdic
