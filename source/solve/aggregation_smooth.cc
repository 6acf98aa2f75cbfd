#include <nodus/solve/aggregation.h>
#include <nodus/solve/mode_panel.h>
#include <nodus/some_to_some.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace Nodus
{
  using ModePanel::add_product;
  using ModePanel::n_modes;
  using ModePanel::none;
  using ModePanel::Panel;
  using ModePanel::SparseRow;

  namespace
  {
    constexpr DoFIndex no_aggregate = dealii::numbers::invalid_dof_index;

    using PanelRow = std::map<DoFIndex, Panel>; // by global aggregate

    /// P_0 at all local nodes.
    struct Tentative
    {
      std::vector<DoFIndex> aggregates; ///< global, or no_aggregate
      std::vector<Panel>    panels;
    };

    Tentative at_local_nodes(const NodeMap                   &nodes,
                             const std::vector<double>       &tentative,
                             const std::vector<unsigned int> &aggregate,
                             const DoFIndex                   first)
    {
      const unsigned int n_owned = nodes.n_owned(), n = nodes.size();
      Tentative          result;
      result.panels.resize(n, Panel{});
      for (unsigned int m = 0; m < n_modes; ++m)
      {
        const NodeValues mode = nodes.with_ghosts(tentative.data() + m * dim * n_owned);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int c = 0; c < dim; ++c)
            result.panels[i].row[c][m] = mode[i][c];
      }
      std::vector<double> numbers(dim * n_owned + 1, -1.);
      for (unsigned int i = 0; i < n_owned; ++i)
        if (aggregate[i] != none)
          numbers[dim * i] = first + aggregate[i];
      const NodeValues number = nodes.with_ghosts(numbers.data());
      for (unsigned int i = 0; i < n; ++i)
        result.aggregates.push_back(*number[i] >= 0. ? static_cast<DoFIndex>(*number[i]) : no_aggregate);
      return result;
    }

    /// What T and R add to A P_0: rows of owned nodes. Collective.
    std::map<unsigned int, PanelRow>
    constrained_rows(const ConstrainedMatrix &A, const NodeMatrix &K, const Tentative &P_0)
    {
      const NodeMap &nodes        = A.map();
      const auto     for_row_of_T = [&](const unsigned int node, const auto &f)
      {
        for (const auto &[i, block] : *A.replacement(node))
          if (P_0.aggregates[i] != no_aggregate)
            f(P_0.aggregates[i], block.data(), P_0.panels[i]);
      };
      std::map<unsigned int, PanelRow> rows;
      const auto add_transposed = [&](const ConstrainedMatrix::LocalRow &row, const PanelRow &panels)
      {
        for (const auto &[i, block] : row)
          for (const auto &[a, panel] : panels)
            add_product(block.data(), true, panel, rows[i].try_emplace(a, Panel{}).first->second);
      };
      for (const auto &[z, T_z] : A.replacements())
      {
        if (z >= nodes.n_owned())
          continue;
        PanelRow sum; // of K T P_0
        K.for_row(z,
                  [&](const unsigned int j, const double *block, const bool transposed)
                  {
                    const auto add = [&](const DoFIndex a, const Panel &panel)
                    { add_product(block, transposed, panel, sum.try_emplace(a, Panel{}).first->second); };
                    if (A.replacement(j))
                      for_row_of_T(j,
                                   [&](const DoFIndex a, const double *const T_block, const Panel &panel)
                                   {
                                     Panel p{};
                                     add_product(T_block, false, panel, p);
                                     add(a, p);
                                   });
                    else if (P_0.aggregates[j] != no_aggregate)
                      add(P_0.aggregates[j], P_0.panels[j]);
                  });
        add_transposed(T_z, sum);
      }
      for (const auto &spring : A.springs())
      {
        PanelRow sum; // of R P_0
        for (const auto &[i, block] : spring.row)
          if (P_0.aggregates[i] != no_aggregate)
            add_product(block.data(), false, P_0.panels[i], sum.try_emplace(P_0.aggregates[i], Panel{}).first->second);
        for (auto &[a, panel] : sum)
        {
          const Panel before = std::exchange(panel, Panel{});
          add_product(spring.D.data(), false, before, panel);
        }
        add_transposed(spring.row, sum);
      }

      // to the owners of the rows: node, aggregate, panel
      std::map<unsigned int, std::vector<double>> outgoing;
      for (auto row = rows.lower_bound(nodes.n_owned()); row != rows.end(); row = rows.erase(row))
        for (const auto &[a, panel] : row->second)
        {
          const DoFIndex       node    = nodes.global(row->first);
          std::vector<double> &numbers = outgoing[nodes.owner(node)];
          numbers.insert(numbers.end(), {static_cast<double>(node), static_cast<double>(a)});
          for (const auto &modes : panel.row)
            for (unsigned int m = 0; m < n_modes; ++m)
              numbers.push_back(modes[m]);
        }
      for (const auto &[rank, numbers] : some_to_some(nodes.communicator(), outgoing))
        for (auto p = numbers.begin(); p != numbers.end();)
        {
          PanelRow &row   = rows[nodes.local(static_cast<DoFIndex>(*p++))];
          Panel    &panel = row.try_emplace(static_cast<DoFIndex>(*p++), Panel{}).first->second;
          for (auto &modes : panel.row)
            for (unsigned int m = 0; m < n_modes; ++m)
              modes[m] += *p++;
        }
      return rows;
    }
  } // namespace

  void Aggregation::smooth(const NodeMatrix &K, const std::vector<std::array<double, 9>> &D_inverse, const double omega)
  {
    const unsigned int n_owned = nodes_.n_owned(), n = nodes_.size();
    const Tentative    P_0                             = at_local_nodes(nodes_, tentative_, aggregate_, first_);
    tentative_                                         = std::vector<double>();
    const std::map<unsigned int, PanelRow> constrained = constrained_rows(A_, K, P_0);

    const auto add_ghost = [&](const DoFIndex a)
    {
      if (a != no_aggregate && !owned(a))
        ghosts_.push_back(a);
    };
    for (unsigned int i = n_owned; i < n; ++i)
      add_ghost(P_0.aggregates[i]);
    for (const auto &[i, row] : constrained)
      for (const auto &[a, panel] : row)
        add_ghost(a);
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
    const auto local = [&](const DoFIndex a) -> unsigned int
    {
      return owned(a) ? a - first_
                      : n_aggregates_ + (std::lower_bound(ghosts_.begin(), ghosts_.end(), a) - ghosts_.begin());
    };
    aggregate_.resize(n, none);
    for (unsigned int i = n_owned; i < n; ++i)
      if (P_0.aggregates[i] != no_aggregate)
        aggregate_[i] = local(P_0.aggregates[i]);

    SparseRow row;
    row.reinit(n_aggregates_ + ghosts_.size());
    start_.assign(1, 0);
    // enough but for few nodes; pages that are not touched take no memory, growing and shrinking would take twice as
    // much
    column_.reserve(5 * n_owned);
    blocks_.reserve(5 * block_size * n_owned + 2);
    const auto add = [&](const unsigned int j, const double *block, const bool transposed)
    {
      if (A_.replacement(j))
      {
        for (const auto &[i, T_block] : *A_.replacement(j))
          if (aggregate_[i] != none)
          {
            Panel p{};
            add_product(T_block.data(), false, P_0.panels[i], p);
            add_product(block, transposed, p, row[aggregate_[i]]);
          }
      }
      else if (aggregate_[j] != none)
        add_product(block, transposed, P_0.panels[j], row[aggregate_[j]]);
    };
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      if (!A_.replacement(i))
        K.for_row(i, add);
      if (const auto more = constrained.find(i); more != constrained.end())
        for (const auto &[a, panel] : more->second)
          for (unsigned int c = 0; c < dim; ++c)
            row[local(a)].row[c] += panel.row[c];
      if (aggregate_[i] != none)
        row[aggregate_[i]];
      for (unsigned int k = 0; k < row.columns().size(); ++k)
      {
        const unsigned int a = row.columns()[k];
        Panel              p{};
        add_product(D_inverse[i].data(), false, row.panel(k), p);
        float block[block_size + 2];
        for (unsigned int c = 0; c < dim; ++c) // in this order: each row overwrites what the one before spilt over
        {
          const auto exact   = a == aggregate_[i] ? P_0.panels[i].row[c] - omega * p.row[c] : -omega * p.row[c];
          const auto rounded = __builtin_convertvector(exact, ModePanel::Stored);
          std::memcpy(block + n_modes * c, &rounded, sizeof(rounded));
        }
        if (std::all_of(block, block + block_size, [](const float value) { return value == 0.F; }))
          continue;
        column_.push_back(a);
        blocks_.insert(blocks_.end(), block, block + block_size);
      }
      row.clear();
      start_.push_back(column_.size());
    }
    blocks_.resize(blocks_.size() + 2, 0.F); // for load()
  }
} // namespace Nodus
