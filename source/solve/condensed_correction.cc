#include <nodus/solve/condensation.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;

    /// Sums of 3x3 blocks by (row, column) of global nodes.
    class BlockSum
    {
    public:
      Matrix3 &operator()(const DoFIndex row, const DoFIndex column)
      {
        const auto found = position_.try_emplace((static_cast<std::uint64_t>(row) << 32) | column, blocks_.size());
        if (found.second)
          blocks_.emplace_back(Matrix3::Zero());
        return blocks_[found.first->second];
      }
      std::vector<MatrixEntry> entries() const
      {
        std::vector<std::pair<std::uint64_t, std::size_t>> order(position_.begin(), position_.end());
        std::sort(order.begin(), order.end());
        std::vector<MatrixEntry> result;
        result.reserve(9 * order.size());
        for (auto first = order.begin(); first != order.end();)
        {
          const DoFIndex row  = first->first >> 32; // the column is the lower half
          const auto     last = std::find_if(first, order.end(), [&](const auto &o) { return o.first >> 32 != row; });
          for (unsigned int c = 0; c < dim; ++c)
            for (auto o = first; o != last; ++o)
              for (unsigned int d = 0; d < dim; ++d)
                if (const double value = blocks_[o->second](c, d); value != 0.)
                  result.push_back({dim * row + c, dim * static_cast<DoFIndex>(o->first) + d, value});
          first = last;
        }
        return result;
      }

    private:
      std::unordered_map<std::uint64_t, std::size_t> position_;
      std::vector<Matrix3>                           blocks_;
    };
  } // namespace

  std::vector<MatrixEntry> Condensation::correction() const
  {
    const NodeMatrix &K = system_.bulk();
    BlockSum          sum;

    // T^T K T where T is not the identity, from the rows of K of the nodes z that it replaces
    std::unordered_map<DoFIndex, Matrix3> W; // row z of K T
    for (unsigned int z = 0; z < nodes_.n_owned(); ++z)
      if (const Row *row = rows_[z].get())
      {
        const DoFIndex z_global = nodes_.global(z);
        W.clear();
        K.for_row(z,
                  [&](const unsigned int c, const double *values, const bool transposed)
                  {
                    // column-major maps: a row-major block is read transposed
                    const Matrix3 stored = Eigen::Map<const Matrix3>(values);
                    const Matrix3 K_zc   = transposed ? stored : Matrix3(stored.transpose());
                    const auto    add    = [&](const DoFIndex node, const Matrix3 &block)
                    { W.try_emplace(node, Matrix3::Zero()).first->second += block; };
                    if (const Row *other = rows_[c].get())
                    {
                      add(nodes_.global(c), K_zc * other->own);
                      for (const Coupling &coupling : other->others)
                        add(coupling.node, K_zc * coupling.block);
                      return;
                    }
                    add(nodes_.global(c), K_zc);
                    sum(nodes_.global(c), z_global) += K_zc.transpose() * row->own;
                    for (const Coupling &coupling : row->others)
                      sum(nodes_.global(c), coupling.node) += K_zc.transpose() * coupling.block;
                  });
        for (const auto &[column, block] : W)
        {
          sum(z_global, column) += row->own.transpose() * block;
          for (const Coupling &coupling : row->others)
            sum(coupling.node, column) += coupling.block.transpose() * block;
        }
      }
    for (const auto &[i, diagonal] : eliminated_)
      sum(nodes_.global(i / dim), nodes_.global(i / dim))(i % dim, i % dim) += diagonal;

    // (B T)^T D B T, and C_uu by what it is along the rows of B
    std::map<DoFIndex, Matrix3> rows;
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      const Site   &site     = sites_[k];
      Matrix3       D        = site.flexibility_inverse.asDiagonal();
      const Matrix3 friction = system_.own_coupling(nodes_.global(site.node));
      if (!friction.isZero(0.))
      {
        // the rows of friction span the plane in which C_uu acts
        const Matrix3 inverse = site.rows.front().block.completeOrthogonalDecomposition().pseudoInverse();
        Matrix3       along   = inverse.transpose() * friction * inverse;
        for (unsigned int i = 0; i < 3; ++i)
          if (site.flexibility_inverse[i] == 0.)
          {
            along.row(i).setZero();
            along.col(i).setZero();
          }
        D += along;
      }
      if (D.isZero(0.))
        continue;
      rows.clear();
      const auto add = [&](const DoFIndex node, const Matrix3 &block)
      { rows.try_emplace(node, Matrix3::Zero()).first->second += block; };
      for (const Coupling &coupling : site.rows)
      {
        const unsigned int local = nodes_.local(coupling.node);
        const Row         *row   = local == dealii::numbers::invalid_unsigned_int ? nullptr : rows_[local].get();
        if (!row)
        {
          add(coupling.node, coupling.block);
          continue;
        }
        add(coupling.node, coupling.block * row->own);
        for (const Coupling &other : row->others)
          add(other.node, coupling.block * other.block);
      }
      for (const auto &[i, row] : rows)
        for (const auto &[j, column] : rows)
          sum(i, j) += row.transpose() * D * column;
    }
    return system_.displacement_ownership().exchange(sum.entries());
  }
} // namespace Nodus
