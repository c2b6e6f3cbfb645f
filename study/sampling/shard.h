#pragma once
#include <functional>
#include <optional>
#include <string>

#include "study/sampling/index_set.h"

namespace asdic::detail::study {

/// "A:B" of --realisations: indices A … B − 1, counted from 0.
/// \param count  realisations of the study
/// \throws InputError ("--realisations") for what is no range of the study's
[[nodiscard]] IndexRange parse_range(const std::string& text, std::uint64_t count);

/// What an environment variable holds; none if it is not set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;

/// "I/N" of --shard, 1 ≤ I ≤ N: the I-th of N parts of the indices, as equal as whole numbers go.
/// "slurm": I and N of a Slurm job array (SLURM_ARRAY_TASK_ID, _MIN, _COUNT), whatever number its
/// tasks begin at.
/// \throws InputError ("--shard")
[[nodiscard]] IndexRange parse_shard(const std::string& text, std::uint64_t count,
                                     const Environment& environment);

/// The I-th of N parts, I from 1.
[[nodiscard]] IndexRange shard(std::uint64_t i, std::uint64_t n, std::uint64_t count) noexcept;

}  // namespace asdic::detail::study
