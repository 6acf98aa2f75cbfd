#include "solve/constrained_matrix.h"

#include <Eigen/Core>

#include <algorithm>

namespace Nodus
{
  namespace
  {
    using Block    = Eigen::Matrix<double, dim, dim, Eigen::RowMajor>;
    using BlockMap = Eigen::Map<const Block>;

    std::vector<DoFIndex> reached(const Constraints &constraints)
    {
      std::vector<DoFIndex> nodes;
      const auto            add = [&](const NodeRow &row)
      {
        for (const auto &[node, block] : row)
          nodes.push_back(node);
      };
      if (constraints.T)
        for (const auto &[node, row] : constraints.T->rows())
          add(row);
      for (const auto &spring : constraints.springs)
        add(spring.row);
      return nodes;
    }
  } // namespace

  ConstrainedMatrix::ConstrainedMatrix(const BlockCsrMatrix &K)
      : K_nodes_(K.shared_map())
      , nodes_(K.shared_map())
      , pattern_(K.pattern())
      , stiffness_(K.values().begin(), K.values().end())
  {
  }

  ConstrainedMatrix::ConstrainedMatrix(const BlockCsrMatrix &K, Constraints constraints)
      : constraints_(std::move(constraints))
      , K_nodes_(K.shared_map())
      , nodes_(std::make_shared<NodeMap>(K.map(), reached(constraints_)))
      , pattern_(K.pattern())
      , stiffness_(K.values().begin(), K.values().end())
      , replacement_(K.map().size(), none)
      , forces_(dim * constraints_.springs.size())
  {
    if (constraints_.T)
      for (const auto &[node, row] : constraints_.T->rows())
      {
        replacement_[node] = T_rows_.size();
        T_rows_.emplace_back(node, to_local(row));
      }
    const Ownership          range(forces_.size(), nodes_->communicator());
    std::vector<MatrixEntry> entries;
    for (const auto &spring : constraints_.springs)
    {
      append_entries(entries, range.begin() + dim * springs_.size(), spring.row);
      springs_.push_back({to_local(spring.row), spring.D});
    }
    R_ = std::make_unique<CouplingMatrix>(entries, range, Ownership(dim * nodes_->n_owned(), nodes_->communicator()));
  }

  ConstrainedMatrix::LocalRow ConstrainedMatrix::to_local(const NodeRow &row) const
  {
    LocalRow result;
    for (const auto &[node, block] : row)
      result.emplace_back(nodes_->local(node), block);
    return result;
  }

  void ConstrainedMatrix::vmult(double *const y, double *const x) const
  {
    const Transformation *const T = constraints_.T.get();
    if (T)
      T->apply(x);
    pattern_->vmult(stiffness_.data(), y, x, *K_nodes_);
    if (T)
    {
      T->restore(x);
      T->apply_transposed(y);
    }
    if (!R_)
      return;
    std::fill(forces_.begin(), forces_.end(), 0.);
    R_->add_product(x, forces_.data());
    for (std::size_t k = 0; k < springs_.size(); ++k)
    {
      Eigen::Map<Eigen::Vector3d> force(&forces_[dim * k]);
      force = (BlockMap(springs_[k].D.data()) * force).eval();
    }
    R_->add_transposed_product(forces_.data(), y);
    for (const auto &[i, d] : constraints_.diagonal)
      y[i] = d * x[i];
  }

  std::vector<std::array<double, 9>> ConstrainedMatrix::diagonal_blocks(const BlockCsrMatrix &K) const
  {
    std::vector<std::array<double, 9>> diagonal(nodes_->size(), std::array<double, 9>{});
    const auto                         add = [&](const unsigned int node, const Block &part)
    { Eigen::Map<Block>(diagonal[node].data()) += part; };
    for (unsigned int i = 0; i < nodes_->n_owned(); ++i)
      if (!replacement(i))
        std::copy_n(K.diagonal(i), 9, diagonal[i].begin());

    // T_zi^T K_zc T_ci; rows z of K that T replaces are enough, K is symmetric
    std::vector<const double *> T_z(nodes_->size(), nullptr);
    for (const auto &[z, row] : T_rows_)
    {
      if (z >= nodes_->n_owned())
        continue;
      for (const auto &[i, block] : row)
        T_z[i] = block.data();
      K.for_row(z,
                [&](const unsigned int c, const double *values, const bool transposed)
                {
                  const Block K_zc = transposed ? Block(BlockMap(values).transpose()) : Block(BlockMap(values));
                  if (const LocalRow *const T_c = replacement(c))
                  {
                    for (const auto &[i, block] : *T_c)
                      if (T_z[i])
                        add(i, BlockMap(T_z[i]).transpose() * K_zc * BlockMap(block.data()));
                  }
                  else if (T_z[c])
                  {
                    const Block part = BlockMap(T_z[c]).transpose() * K_zc;
                    add(c, part + part.transpose());
                  }
                });
      for (const auto &[i, block] : row)
        T_z[i] = nullptr;
    }
    for (const LocalSpring &spring : springs_)
      for (const auto &[i, block] : spring.row)
        add(i, BlockMap(block.data()).transpose() * BlockMap(spring.D.data()) * BlockMap(block.data()));
    for (const auto &[i, d] : constraints_.diagonal)
      diagonal[i / dim][4 * (i % dim)] += d;
    if (R_)
      nodes_->add_from_ghosts(diagonal.data()->data() + 9 * nodes_->n_owned(), diagonal.data()->data(), 9);
    diagonal.resize(nodes_->n_owned());
    return diagonal;
  }
} // namespace Nodus
