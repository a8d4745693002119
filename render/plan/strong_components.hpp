#pragma once

#include <vector>

namespace vrut::plan {

/// The strongly connected components of a directed graph, given by each one's successors: each component
/// after all that it leads to, its members by rising number (Tarjan 1972, without recursion).
std::vector<std::vector<unsigned>> strong_components(const std::vector<std::vector<unsigned>>& successors);

}  // namespace vrut::plan
