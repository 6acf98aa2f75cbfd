#include "solve/multigrid/galerkin_product.h"
#include "solve/mode_panel.h"

#include <algorithm>
#include <map>
#include <utility>

namespace Nodus
{
  using ModePanel::add_product;
  using ModePanel::add_transposed_product;
  using ModePanel::load;
  using ModePanel::Panel;
  using ModePanel::SparseRow;

  namespace
  {
    using Row = std::vector<std::pair<unsigned int, Panel>>; ///< by column

    /// P with the rows of ghost nodes. Its columns are the aggregates that P knows, then others that those rows have.
    class LocalProlongation
    {
    public:
      /// Keeps a reference to @p P. Collective.
      LocalProlongation(const Prolongation &P, const NodeMap &nodes)
          : P_(P)
          , n_owned_(nodes.n_owned())
      {
        const auto rows = nodes.lists_at_ghosts( // global aggregates and blocks of P
            [&](const unsigned int i, std::vector<double> &numbers)
            {
              for (std::uint32_t k = P.start[i]; k < P.start[i + 1]; ++k)
              {
                const float *block = P.block(k);
                numbers.push_back(P.aggregates.global(P.column[k]));
                numbers.insert(numbers.end(), block, block + Prolongation::block_size);
              }
            });
        find_columns(rows);
        ghost_start_.push_back(0);
        for (const auto &row : rows)
        {
          for (auto p = row.begin(); p != row.end(); p += Prolongation::block_size)
          {
            ghost_column_.push_back(column(static_cast<DoFIndex>(*p++)));
            ghost_blocks_.insert(ghost_blocks_.end(), p, p + Prolongation::block_size);
          }
          ghost_start_.push_back(ghost_column_.size());
        }
        ghost_blocks_.resize(ghost_blocks_.size() + 2, 0.F); // for load()
      }

      /// Global aggregate of each column.
      const std::vector<DoFIndex> &columns() const
      {
        return columns_;
      }
      /// Whether the row of an owned node is empty: it is prescribed.
      bool empty(const unsigned int owned) const
      {
        return P_.start[owned] == P_.start[owned + 1];
      }
      /// Calls f(column, block) for the row of a local node.
      template <typename Function>
      void for_row(const unsigned int node, const Function &f) const
      {
        if (node < n_owned_)
          for (std::uint32_t k = P_.start[node]; k < P_.start[node + 1]; ++k)
            f(P_.column[k], P_.block(k));
        else
          for (std::size_t k = ghost_start_[node - n_owned_]; k < ghost_start_[node - n_owned_ + 1]; ++k)
            f(ghost_column_[k], &ghost_blocks_[Prolongation::block_size * k]);
      }

    private:
      void find_columns(const std::vector<std::vector<double>> &ghost_rows)
      {
        const Aggregates &known = P_.aggregates;
        for (unsigned int a = 0; a < known.size(); ++a)
          columns_.push_back(known.global(a));
        std::vector<DoFIndex> others;
        for (const auto &row : ghost_rows)
          for (auto p = row.begin(); p != row.end(); p += 1 + Prolongation::block_size)
            others.push_back(static_cast<DoFIndex>(*p));
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        for (const DoFIndex other : others)
          if (!known.knows(other))
            columns_.push_back(other);
      }
      unsigned int column(const DoFIndex global) const
      {
        if (P_.aggregates.knows(global))
          return P_.aggregates.local(global);
        return std::lower_bound(columns_.begin() + P_.aggregates.size(), columns_.end(), global) - columns_.begin();
      }

      const Prolongation       &P_;
      const unsigned int        n_owned_; ///< nodes
      std::vector<DoFIndex>     columns_;
      std::vector<std::size_t>  ghost_start_;
      std::vector<unsigned int> ghost_column_;
      std::vector<float>        ghost_blocks_;
    };

    /// The upper triangle of P^T A P = Q^T K Q + (R P)^T D R P, Q = T P, in rows of all columns of P.
    class UpperTriangle
    {
    public:
      UpperTriangle(const ConstrainedMatrix &A, const LocalProlongation &P)
          : A_(A)
          , P_(P)
          , rows_(P.columns().size())
      {
        product_.reinit(P.columns().size());
        for (const auto &[node, row] : A.replacements())
          replaced_[node] = times_P(row);
      }

      /// Adds Q^T K Q.
      void add_stiffness(const BlockCsrMatrix &K)
      {
        for (unsigned int i = 0; i < A_.map().n_owned(); ++i)
        {
          const bool is_replaced = A_.replacement(i) != nullptr;
          if (!is_replaced && P_.empty(i))
            continue;
          K.for_row(i,
                    [&](const unsigned int j, const double *block, const bool transposed)
                    {
                      if (A_.replacement(j))
                        for (const auto &[a, panel] : replaced_.at(j))
                          add_product(block, transposed, panel, product_[a]);
                      else
                        P_.for_row(j,
                                   [&](const unsigned int a, const float *const P_block)
                                   { add_product(block, transposed, load(P_block), product_[a]); });
                    });
          if (is_replaced)
            for (const auto &[a, panel] : replaced_.at(i))
              add_to_row(a, &panel);
          else
            P_.for_row(i, [&](const unsigned int a, const float *const P_block) { add_to_row(a, P_block); });
          product_.clear();
        }
      }

      /// Adds (R P)^T D R P.
      void add_springs()
      {
        for (const auto &spring : A_.springs())
        {
          const Row row = times_P(spring.row);
          for (const auto &[a, panel] : row)
            add_product(spring.D.data(), false, panel, product_[a]);
          for (const auto &[a, panel] : row)
            add_to_row(a, &panel);
          product_.clear();
        }
      }

      /// The rows, by column of P; none are left here.
      std::vector<CoarseRow> take_rows()
      {
        return std::move(rows_);
      }

    private:
      Row times_P(const ConstrainedMatrix::LocalRow &nodes)
      {
        for (const auto &entry : nodes)
          P_.for_row(entry.first,
                     [&](const unsigned int a, const float *const P_block)
                     { add_product(entry.second.data(), false, load(P_block), product_[a]); });
        Row row;
        for (unsigned int l = 0; l < product_.columns().size(); ++l)
          row.emplace_back(product_.columns()[l], product_.panel(l));
        product_.clear();
        return row;
      }

      /// Adds block^T times the product to the row of column @p a; the block is a Panel or stored.
      template <typename Block>
      void add_to_row(const unsigned int a, const Block *const block)
      {
        const std::vector<DoFIndex> &columns = P_.columns();
        for (unsigned int l = 0; l < product_.columns().size(); ++l)
          if (const DoFIndex b = columns[product_.columns()[l]]; columns[a] <= b)
            add_transposed_product(block, product_.panel(l), rows_[a][b]);
      }

      const ConstrainedMatrix    &A_;
      const LocalProlongation    &P_;
      SparseRow                   product_;  ///< K or D times rows of Q or R P, for one row at a time
      std::map<unsigned int, Row> replaced_; ///< rows of Q where T is not the identity
      std::vector<CoarseRow>      rows_;
    };
  } // namespace

  std::unique_ptr<BlockCsrMatrix>
  galerkin_product(const BlockCsrMatrix &K, const ConstrainedMatrix &A, const Prolongation &P)
  {
    const LocalProlongation P_local(P, A.map());
    UpperTriangle           triangle(A, P_local);
    triangle.add_stiffness(K);
    triangle.add_springs();
    const std::vector<DoFIndex> elsewhere(P_local.columns().begin() + P.aggregates.n_owned, P_local.columns().end());
    return make_coarse_matrix(triangle.take_rows(), P.aggregates.starts, elsewhere, A.map().communicator());
  }
} // namespace Nodus
