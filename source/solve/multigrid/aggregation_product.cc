#include "solve/mode_panel.h"
#include "solve/multigrid/aggregation.h"
#include "solve/multigrid/coarse_matrix.h"

#include <algorithm>
#include <map>

namespace Nodus
{
  using ModePanel::add_product;
  using ModePanel::add_transposed_product;
  using ModePanel::load;
  using ModePanel::Panel;
  using ModePanel::SparseRow;

  std::unique_ptr<BlockCsrMatrix> Aggregation::make_coarse_matrix(const BlockCsrMatrix &K) const
  {
    // P^T A P = Q^T K Q + (R P)^T D R P, Q = T P. Their columns: aggregates in the rows of P of all local nodes
    const unsigned int    n_owned    = nodes_.n_owned();
    const auto            ghost_rows = nodes_.lists_at_ghosts( // global aggregates and blocks of P
        [&](const unsigned int i, std::vector<double> &numbers)
        {
          for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
          {
            const float *block = blocks_.data() + block_size * std::size_t(k);
            numbers.push_back(global_aggregate(column_[k]));
            numbers.insert(numbers.end(), block, block + block_size);
          }
        });
    std::vector<DoFIndex> columns;
    for (unsigned int a = 0; a < n_aggregates_ + ghosts_.size(); ++a)
      columns.push_back(global_aggregate(a));
    std::vector<DoFIndex> others;
    for (const auto &row : ghost_rows)
      for (auto p = row.begin(); p != row.end(); p += 1 + block_size)
        others.push_back(static_cast<DoFIndex>(*p));
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    const unsigned int n_known = columns.size();
    for (const DoFIndex other : others)
      if (!owned(other) && !std::binary_search(ghosts_.begin(), ghosts_.end(), other))
        columns.push_back(other);
    const auto column = [&](const DoFIndex global) -> unsigned int
    {
      if (owned(global))
        return global - first_;
      auto found = std::lower_bound(columns.begin() + n_aggregates_, columns.begin() + n_known, global);
      if (found == columns.begin() + n_known || *found != global)
        found = std::lower_bound(columns.begin() + n_known, columns.end(), global);
      return found - columns.begin();
    };

    std::vector<std::size_t>  ghost_start(1, 0);
    std::vector<unsigned int> ghost_column;
    std::vector<float>        ghost_blocks;
    for (const auto &row : ghost_rows)
    {
      for (auto p = row.begin(); p != row.end(); p += block_size)
      {
        ghost_column.push_back(column(static_cast<DoFIndex>(*p++)));
        ghost_blocks.insert(ghost_blocks.end(), p, p + block_size);
      }
      ghost_start.push_back(ghost_column.size());
    }
    ghost_blocks.resize(ghost_blocks.size() + 2, 0.F); // for load()
    const auto for_row_of_P = [&](const unsigned int j, const auto &f)
    {
      if (j < n_owned)
        for (std::uint32_t k = start_[j]; k < start_[j + 1]; ++k)
          f(column_[k], &blocks_[block_size * std::size_t(k)]);
      else
        for (std::size_t k = ghost_start[j - n_owned]; k < ghost_start[j - n_owned + 1]; ++k)
          f(ghost_column[k], &ghost_blocks[block_size * k]);
    };

    SparseRow product;
    product.reinit(columns.size());
    using Row               = std::vector<std::pair<unsigned int, Panel>>; // by column
    const auto take_product = [&]
    {
      Row row;
      for (unsigned int l = 0; l < product.columns().size(); ++l)
        row.emplace_back(product.columns()[l], product.panel(l));
      product.clear();
      return row;
    };
    const auto times_P = [&](const ConstrainedMatrix::LocalRow &row)
    {
      for (const auto &[i, block] : row)
        for_row_of_P(i,
                     [&](const unsigned int a, const float *const P_block)
                     { add_product(block.data(), false, load(P_block), product[a]); });
      return take_product();
    };
    std::map<unsigned int, Row> replaced; // rows of Q
    for (const auto &[node, row] : A_.replacements())
      replaced[node] = times_P(row);

    // the upper triangle
    std::vector<CoarseRow> rows(columns.size());
    const auto             add_to_row = [&](const unsigned int a, const auto *const block)
    {
      for (unsigned int l = 0; l < product.columns().size(); ++l)
        if (const DoFIndex b = columns[product.columns()[l]]; columns[a] <= b)
          add_transposed_product(block, product.panel(l), rows[a][b]);
    };
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      const bool is_replaced = A_.replacement(i) != nullptr;
      if (!is_replaced && start_[i] == start_[i + 1])
        continue;
      K.for_row(i,
                [&](const unsigned int j, const double *block, const bool transposed)
                {
                  if (A_.replacement(j))
                    for (const auto &[a, panel] : replaced.at(j))
                      add_product(block, transposed, panel, product[a]);
                  else
                    for_row_of_P(j,
                                 [&](const unsigned int a, const float *const P_block)
                                 { add_product(block, transposed, load(P_block), product[a]); });
                });
      if (is_replaced)
        for (const auto &[a, panel] : replaced.at(i))
          add_to_row(a, &panel);
      else
        for_row_of_P(i, add_to_row);
      product.clear();
    }
    for (const auto &spring : A_.springs())
    {
      const Row row = times_P(spring.row);
      for (const auto &[a, panel] : row)
        add_product(spring.D.data(), false, panel, product[a]);
      for (const auto &[a, panel] : row)
        add_to_row(a, &panel);
      product.clear();
    }
    const std::vector<DoFIndex> elsewhere(columns.begin() + n_aggregates_, columns.end());
    return Nodus::make_coarse_matrix(std::move(rows), starts_, elsewhere, nodes_.communicator());
  }
} // namespace Nodus
