#include "lab/compact/code_lengths.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace voxdag::lab {
namespace {

/// A symbol, or a package of two neighbours of the list before.
struct Item {
  std::uint64_t weight = 0;
  int symbol = -1;  ///< -1: a package.
};

}  // namespace

std::vector<int> code_lengths(std::span<const std::uint64_t> frequencies, int limit) {
  assert(frequencies.size() >= 2 && frequencies.size() <= std::size_t{1} << limit);
  std::vector<Item> symbols;
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    symbols.push_back({frequencies[i], static_cast<int>(i)});
  std::stable_sort(symbols.begin(), symbols.end(),
                   [](const Item& a, const Item& b) { return a.weight < b.weight; });

  // lists[k] holds the symbols and the packages of neighbours in lists[k - 1], lightest first.
  std::vector<std::vector<Item>> lists{symbols};
  while (static_cast<int>(lists.size()) < limit) {
    const std::vector<Item>& before = lists.back();
    std::vector<Item> packages, list;
    for (std::size_t i = 0; i + 1 < before.size(); i += 2)
      packages.push_back({before[i].weight + before[i + 1].weight});
    std::merge(symbols.begin(), symbols.end(), packages.begin(), packages.end(),
               std::back_inserter(list),
               [](const Item& a, const Item& b) { return a.weight < b.weight; });
    lists.push_back(std::move(list));
  }

  // A symbol's length is the number of lists of which it is taken. Of the last list the lightest
  // 2n - 2 items are taken, of each list before it those in taken packages.
  std::vector<int> lengths(frequencies.size(), 0);
  std::size_t taken = 2 * frequencies.size() - 2;
  for (std::size_t k = lists.size(); k-- > 0;) {
    std::size_t packages = 0;
    for (std::size_t i = 0; i < taken; ++i) {
      const int symbol = lists[k][i].symbol;
      if (symbol < 0)
        ++packages;
      else
        ++lengths[symbol];
    }
    taken = 2 * packages;
  }
  return lengths;
}

}  // namespace voxdag::lab
