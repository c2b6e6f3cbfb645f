#pragma once
#include <string>
#include <vector>

#include "study/sampling/proposal.h"
#include "study/sampling/variable.h"

namespace asdic::detail::support {

/// An input that is standard normal.
inline study::Variable normal_input(const std::string& name) {
  return {.name = name,
          .keys = {name},
          .origin = "",
          .law = study::NumberLaw{study::CutLaw(study::Normal{0.0, 1.0})}};
}

/// Laws, a wide part and these components, as the reader makes them.
inline study::Proposal mixture(const std::vector<std::vector<study::CoordinateDraw>>& components,
                               double share = 0.1, double wide = 0.2) {
  std::vector<study::ProposalPart> parts{{.name = "laws", .share = share, .guards = true}};
  if (wide > 0.0) {
    parts.push_back({.name = "wide", .share = wide, .guards = true});
    parts.back().draws.assign(components.front().size(), study::ScoreLaw{0.0, 3.0});
  }
  for (const auto& component : components)
    parts.push_back({.name = "component",
                     .share = (1.0 - share - wide) / static_cast<double>(components.size()),
                     .draws = component});
  return study::Proposal(parts);
}

}  // namespace asdic::detail::support
