// How many nodes a tree has.
#pragma once

#include <cstddef>
#include <vector>

namespace racebeam {

// Counts without recursion, because a chain of nodes may be too long for the stack. The root is null before
// the first search, and so are children that were not made.
template <class Node>
std::size_t count_nodes(const Node* root) {
  std::size_t count = 0;
  std::vector<const Node*> open;
  if (root) open.push_back(root);
  while (!open.empty()) {
    const Node* const node = open.back();
    open.pop_back();
    ++count;
    for (const auto& child : node->children)
      if (child) open.push_back(child.get());
  }
  return count;
}

}  // namespace racebeam
