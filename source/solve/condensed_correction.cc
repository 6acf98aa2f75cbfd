#include <nodus/solve/condensation.h>
#include <nodus/some_to_some.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <map>

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;

    /// Sums of 3x3 blocks by (row, column) of global nodes, found in a table with open addressing.
    class BlockSum
    {
    public:
      Matrix3 &operator()(const DoFIndex row, const DoFIndex column)
      {
        if (2 * (keys_.size() + 1) > table_.size())
          grow();
        const std::uint64_t key  = (static_cast<std::uint64_t>(row) << 32) | column;
        const std::size_t   slot = find(key);
        if (table_[slot] == none)
        {
          table_[slot] = keys_.size();
          keys_.push_back(key);
          blocks_.emplace_back(Matrix3::Zero());
        }
        return blocks_[table_[slot]];
      }
      void clear()
      {
        std::fill(table_.begin(), table_.end(), none);
        keys_.clear();
        blocks_.clear();
      }
      /// Calls f(row, column, block) in the order in which the blocks came.
      template <typename Function>
      void for_each(const Function &f) const
      {
        for (std::size_t k = 0; k < keys_.size(); ++k)
          f(static_cast<DoFIndex>(keys_[k] >> 32), static_cast<DoFIndex>(keys_[k]), blocks_[k]);
      }
      /// Sorted, of the rows for which @p wanted holds.
      template <typename Predicate>
      std::vector<MatrixEntry> entries(const Predicate &wanted) const
      {
        std::vector<std::pair<std::uint64_t, std::size_t>> order;
        order.reserve(keys_.size());
        for (std::size_t k = 0; k < keys_.size(); ++k)
          if (wanted(static_cast<DoFIndex>(keys_[k] >> 32)))
            order.emplace_back(keys_[k], k);
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
      static constexpr std::uint32_t none = -1;

      std::size_t find(const std::uint64_t key) const
      {
        const std::size_t mask = table_.size() - 1;
        std::size_t       slot = (key * 0x9e3779b97f4a7c15U) >> 32 & mask;
        while (table_[slot] != none && keys_[table_[slot]] != key)
          slot = (slot + 1) & mask;
        return slot;
      }
      void grow()
      {
        table_.assign(std::max<std::size_t>(64, 2 * table_.size()), none);
        for (std::uint32_t k = 0; k < keys_.size(); ++k)
          table_[find(keys_[k])] = k;
      }

      std::vector<std::uint32_t> table_; ///< index into the others, or none; the size is a power of two
      std::vector<std::uint64_t> keys_;
      std::vector<Matrix3>       blocks_;
    };

    /// Hands the blocks of rows that are owned elsewhere to their owners, who add them to theirs. Collective.
    void add_from_other_ranks(BlockSum &sum, const Ownership &rows, const NodeMap &nodes)
    {
      std::map<unsigned int, std::vector<double>> outgoing; // row, column, block
      sum.for_each(
          [&](const DoFIndex row, const DoFIndex column, const Matrix3 &block)
          {
            if (nodes.local(row) < nodes.n_owned())
              return;
            std::vector<double> &numbers = outgoing[rows.owner(dim * row)];
            numbers.push_back(row);
            numbers.push_back(column);
            numbers.insert(numbers.end(), block.data(), block.data() + 9);
          });
      for (const auto &[rank, numbers] : some_to_some(nodes.communicator(), outgoing))
        for (auto p = numbers.begin(); p != numbers.end(); p += 11)
          sum(static_cast<DoFIndex>(p[0]), static_cast<DoFIndex>(p[1])) += Eigen::Map<const Matrix3>(&p[2]);
    }
  } // namespace

  std::vector<MatrixEntry> Condensation::correction() const
  {
    const NodeMatrix &K = system_.bulk();
    BlockSum          sum;

    // T^T K T where T is not the identity, from the rows of K of the nodes z that it replaces
    BlockSum W; // row z of K T
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
                    const auto    add = [&](const DoFIndex node, const Matrix3 &block) { W(z_global, node) += block; };
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
        W.for_each(
            [&](const DoFIndex, const DoFIndex column, const Matrix3 &block)
            {
              sum(z_global, column) += row->own.transpose() * block;
              for (const Coupling &coupling : row->others)
                sum(coupling.node, column) += coupling.block.transpose() * block;
            });
      }
    for (const auto &[i, diagonal] : eliminated_)
      sum(nodes_.global(i / dim), nodes_.global(i / dim))(i % dim, i % dim) += diagonal;

    for (const Site &site : sites_)
      if (const Matrix3 D = stiffness_along_rows(site); !D.isZero(0.))
      {
        const std::map<DoFIndex, Matrix3> rows = transformed_rows(site);
        for (const auto &[i, row] : rows)
          for (const auto &[j, column] : rows)
            sum(i, j) += row.transpose() * D * column;
      }
    add_from_other_ranks(sum, system_.displacement_ownership(), nodes_);
    return sum.entries([&](const DoFIndex row) { return nodes_.local(row) < nodes_.n_owned(); });
  }

  Condensation::Matrix3 Condensation::stiffness_along_rows(const Site &site) const
  {
    const Matrix3 D        = site.flexibility_inverse.asDiagonal();
    const Matrix3 friction = system_.own_coupling(nodes_.global(site.node));
    if (friction.isZero(0.))
      return D;
    // the rows of friction span the plane in which C_uu acts
    const Matrix3 inverse = site.rows.front().block.completeOrthogonalDecomposition().pseudoInverse();
    Matrix3       along   = inverse.transpose() * friction * inverse;
    for (unsigned int i = 0; i < 3; ++i)
      if (site.flexibility_inverse[i] == 0.)
      {
        along.row(i).setZero();
        along.col(i).setZero();
      }
    return D + along;
  }

  std::map<DoFIndex, Condensation::Matrix3> Condensation::transformed_rows(const Site &site) const
  {
    std::map<DoFIndex, Matrix3> rows;
    const auto                  add = [&](const DoFIndex node, const Matrix3 &block)
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
    return rows;
  }

  CorrectionFactors Condensation::correction_factors() const
  {
    CorrectionFactors factors;
    factors.T = T_;
    factors.d = eliminated_;
    factors.D.resize(sites_.size());
    std::vector<MatrixEntry> entries;
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      const Matrix3 D = stiffness_along_rows(sites_[k]);
      Eigen::Map<Matrix3>(factors.D[k].data()) = D;
      if (D.isZero(0.))
        continue;
      const std::map<DoFIndex, Matrix3> rows = transformed_rows(sites_[k]);
      for (unsigned int a = 0; a < 3; ++a)
        for (const auto &[node, block] : rows)
          for (unsigned int d = 0; d < dim; ++d)
            if (block(a, d) != 0.)
              entries.push_back({system_.multiplier_ownership().begin() + 3 * k + a, dim * node + d, block(a, d)});
    }
    factors.R = std::make_unique<const CouplingMatrix>(
        entries, system_.multiplier_ownership(), system_.displacement_ownership());
    return factors;
  }
} // namespace Nodus
