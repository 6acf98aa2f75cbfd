#include "base/box_tree.h"

#include <numeric>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Things in a leaf, at most.
    constexpr unsigned int leaf_size = 4;
  } // namespace

  BoxTree::BoxTree(std::vector<TreeBox> boxes)
      : boxes_(std::move(boxes))
      , numbers_(boxes_.size())
  {
    std::iota(numbers_.begin(), numbers_.end(), 0);
    nodes_.reserve(boxes_.size());
    build(0, boxes_.size());
  }

  void BoxTree::build(const unsigned int first, const unsigned int last)
  {
    const unsigned int at = nodes_.size();
    nodes_.emplace_back();
    TreeBox    centres; // twice
    const auto centre = [&](const unsigned int number, const unsigned int c)
    { return boxes_[number].lower[c] + boxes_[number].upper[c]; };
    for (unsigned int i = first; i < last; ++i)
    {
      nodes_[at].box.add(boxes_[numbers_[i]]);
      centres.add(Point(centre(numbers_[i], 0), centre(numbers_[i], 1), centre(numbers_[i], 2)));
    }
    if (last - first <= leaf_size)
    {
      nodes_[at].first = first;
      nodes_[at].n     = last - first;
      return;
    }
    unsigned int along = 0;
    for (unsigned int c = 1; c < dim; ++c)
      if (centres.upper[c] - centres.lower[c] > centres.upper[along] - centres.lower[along])
        along = c;
    const unsigned int middle = first + (last - first) / 2;
    std::nth_element(numbers_.begin() + first,
                     numbers_.begin() + middle,
                     numbers_.begin() + last,
                     [&](const unsigned int a, const unsigned int b)
                     { return std::make_pair(centre(a, along), a) < std::make_pair(centre(b, along), b); });
    build(first, middle);
    nodes_[at].first = nodes_.size();
    build(middle, last);
  }
} // namespace Nodus
