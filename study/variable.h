#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace asdic::study {

/// One input that varies from realisation to realisation: a key of the scenario (or several that
/// move together) and the law that its values follow.
struct Variable {
  std::string name;               ///< of its column
  std::vector<std::string> keys;  ///< "target.0.strength_db"; paths as in --set
};

}  // namespace asdic::study
