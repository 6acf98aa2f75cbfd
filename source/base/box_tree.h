#ifndef nodus_base_box_tree_h
#define nodus_base_box_tree_h

#include <nodus/base/types.h>

#include <deal.II/base/bounding_box.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace Nodus
{
  /// A box along the axes.
  struct TreeBox
  {
    std::array<double, dim> lower, upper;

    TreeBox()
    {
      lower.fill(std::numeric_limits<double>::max());
      upper.fill(-std::numeric_limits<double>::max());
    }
    explicit TreeBox(const dealii::BoundingBox<dim> &box)
    {
      for (unsigned int c = 0; c < dim; ++c)
      {
        lower[c] = box.lower_bound(c);
        upper[c] = box.upper_bound(c);
      }
    }
    void add(const Point &p)
    {
      for (unsigned int c = 0; c < dim; ++c)
      {
        lower[c] = std::min(lower[c], p[c]);
        upper[c] = std::max(upper[c], p[c]);
      }
    }
    void add(const TreeBox &box)
    {
      for (unsigned int c = 0; c < dim; ++c)
      {
        lower[c] = std::min(lower[c], box.lower[c]);
        upper[c] = std::max(upper[c], box.upper[c]);
      }
    }
    bool meets(const TreeBox &other) const
    {
      for (unsigned int c = 0; c < dim; ++c)
        if (lower[c] > other.upper[c] || other.lower[c] > upper[c])
          return false;
      return true;
    }
    /// Squared distance of a point, 0 inside.
    double squared_distance(const Point &p) const
    {
      double result = 0.;
      for (unsigned int c = 0; c < dim; ++c)
      {
        const double d = std::max({lower[c] - p[c], 0., p[c] - upper[c]});
        result += d * d;
      }
      return result;
    }
  };

  /// A balanced binary tree of boxes: what is nearest to a point is found without looking at what is farther, and what
  /// meets a box likewise, without allocating anything, as queries of an rtree do.
  class BoxTree
  {
  public:
    /// @p boxes: of the things in the tree, by their numbers.
    explicit BoxTree(std::vector<TreeBox> boxes = {});

    const TreeBox &box(const unsigned int number) const
    {
      return boxes_[number];
    }
    /// Calls visit(number, squared) for things whose boxes are nearer to @p p than the squared distance that it
    /// returns, those in nearer boxes first; @p squared: what it may be at first.
    template <typename Visit>
    void nearest(const Point &p, double squared, const Visit &visit) const
    {
      std::array<std::pair<unsigned int, double>, 2 * most_levels> open; // nodes and how far they are
      unsigned int                                                 n = 0;
      open[n++]                                                      = {0, nodes_[0].box.squared_distance(p)};
      while (n > 0)
      {
        const auto [at, distance] = open[--n];
        if (distance >= squared)
          continue;
        const Node &node = nodes_[at];
        if (node.n > 0)
        {
          for (unsigned int i = node.first; i < node.first + node.n; ++i)
            if (boxes_[numbers_[i]].squared_distance(p) < squared)
              squared = std::min(squared, visit(numbers_[i], squared));
          continue;
        }
        const unsigned int child[2] = {at + 1, node.first};
        const double       of[2] = {nodes_[child[0]].box.squared_distance(p), nodes_[child[1]].box.squared_distance(p)};
        const unsigned int nearer = of[1] < of[0] ? 1 : 0;
        open[n++]                 = {child[1 - nearer], of[1 - nearer]};
        open[n++]                 = {child[nearer], of[nearer]};
      }
    }

    /// Calls visit(number) for things whose boxes meet @p box, in no order.
    template <typename Visit>
    void meeting(const TreeBox &box, const Visit &visit) const
    {
      std::array<unsigned int, 2 * most_levels> open;
      unsigned int                              n = 0;
      open[n++]                                   = 0;
      while (n > 0)
      {
        const unsigned int at   = open[--n];
        const Node        &node = nodes_[at];
        if (!node.box.meets(box))
          continue;
        for (unsigned int i = node.first; i < node.first + node.n; ++i)
          if (boxes_[numbers_[i]].meets(box))
            visit(numbers_[i]);
        if (node.n > 0)
          continue;
        open[n++] = node.first;
        open[n++] = at + 1;
      }
    }

  private:
    static constexpr unsigned int most_levels = 32; ///< halves of 2^32 things

    /// Its first child is the next node; a leaf has things instead.
    struct Node
    {
      TreeBox      box;
      unsigned int first; ///< of the things of a leaf in numbers_, or the second child
      unsigned int n = 0; ///< things of a leaf
    };
    void build(unsigned int first, unsigned int last);

    std::vector<TreeBox>      boxes_;
    std::vector<Node>         nodes_;
    std::vector<unsigned int> numbers_;
  };
} // namespace Nodus

#endif
