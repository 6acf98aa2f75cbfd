#ifndef nodus_solve_node_block_h
#define nodus_solve_node_block_h

#include <nodus/base/types.h>

#include <Eigen/Core>

#include <array>
#include <vector>

namespace Nodus
{
  /// Three rows times the displacement of a node.
  struct NodeBlock
  {
    DoFIndex        node; ///< global
    Eigen::Matrix3d block;
  };

  inline std::array<double, 9> by_rows(const Eigen::Matrix3d &block)
  {
    std::array<double, 9> result;
    Eigen::Map<Eigen::Matrix<double, dim, dim, Eigen::RowMajor>>(result.data()) = block;
    return result;
  }

  // Blocks as numbers, on their way to other ranks.

  inline void append(std::vector<double> &numbers, const Eigen::Matrix3d &block)
  {
    numbers.insert(numbers.end(), block.data(), block.data() + 9);
  }
  /// Reads what append() wrote, and moves on behind it.
  inline Eigen::Matrix3d read(const double *&numbers)
  {
    const Eigen::Matrix3d block = Eigen::Map<const Eigen::Matrix3d>(numbers);
    numbers += 9;
    return block;
  }
} // namespace Nodus

#endif
