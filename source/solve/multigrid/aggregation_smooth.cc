#include "parallel/sparse_exchange.h"
#include "solve/mode_panel.h"
#include "solve/multigrid/aggregation.h"

#include <algorithm>
#include <cstring>
#include <deque>
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
    using Row = std::vector<std::pair<unsigned int, Panel>>; ///< by column

    /// The sum, which is empty then.
    Row take(SparseRow &sum)
    {
      Row row;
      row.reserve(sum.columns().size());
      for (unsigned int k = 0; k < sum.columns().size(); ++k)
        row.emplace_back(sum.columns()[k], sum.panel(k));
      sum.clear();
      return row;
    }

    /// P_0 at all local nodes.
    struct Tentative
    {
      std::vector<DoFIndex>       aggregates; ///< global number of each column
      std::vector<unsigned int>   column;     ///< of each node, or none
      std::vector<unsigned int>   unreplaced; ///< the same where T is the identity, and none elsewhere
      std::vector<Panel>          panels;     ///< of each node
      std::map<unsigned int, Row> replaced;   ///< rows of T P_0 at nodes that T replaces
    };

    void find_unreplaced(const ConstrainedMatrix &A, Tentative &P_0)
    {
      P_0.unreplaced = P_0.column;
      for (const auto &[z, row] : A.replacements())
        P_0.unreplaced[z] = none;
    }

    Tentative at_local_nodes(const ConstrainedMatrix         &A,
                             const std::vector<double>       &tentative,
                             const std::vector<unsigned int> &aggregate,
                             const DoFIndex                   first)
    {
      const NodeMap     &nodes   = A.map();
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
        if (*number[i] >= 0.)
          result.aggregates.push_back(static_cast<DoFIndex>(*number[i]));
      make_unique_ascending(result.aggregates);
      for (unsigned int i = 0; i < n; ++i)
        result.column.push_back(*number[i] < 0.
                                    ? none
                                    : std::lower_bound(result.aggregates.begin(), result.aggregates.end(), *number[i]) -
                                          result.aggregates.begin());
      SparseRow sum;
      sum.reinit(result.aggregates.size());
      for (const auto &[z, T_z] : A.replacements())
      {
        for (const auto &[i, block] : T_z)
          if (result.column[i] != none)
            add_product(block.data(), false, result.panels[i], sum[result.column[i]]);
        result.replaced[z] = take(sum);
      }
      find_unreplaced(A, result);
      return result;
    }

    /// sum += block (T P_0)_j
    inline void add_row(const ConstrainedMatrix &A,
                        const Tentative         &P_0,
                        const unsigned int       j,
                        const double *const      block,
                        const bool               transposed,
                        SparseRow               &sum)
    {
      if (const unsigned int a = P_0.unreplaced[j]; a != none)
        add_product(block, transposed, P_0.panels[j], sum[a]);
      else if (A.replacement(j))
        for (const auto &[a, panel] : P_0.replaced.at(j))
          add_product(block, transposed, panel, sum[a]);
    }

    using PanelRow = std::map<DoFIndex, Panel>; // by global aggregate

    /// What T and R add to A P_0: rows of owned nodes. Collective.
    std::map<unsigned int, PanelRow>
    constrained_rows(const ConstrainedMatrix &A, const BlockCsrMatrix &K, const Tentative &P_0)
    {
      const NodeMap &nodes = A.map();
      SparseRow      sum;
      sum.reinit(P_0.aggregates.size());
      std::deque<Row>                                                             products;
      std::map<unsigned int, std::vector<std::pair<const Row *, const double *>>> uses; // of products in row i
      const auto add = [&](const ConstrainedMatrix::LocalRow &row)
      {
        products.push_back(take(sum));
        for (const auto &[i, block] : row)
          uses[i].emplace_back(&products.back(), block.data());
      };
      for (const auto &[z, T_z] : A.replacements())
        if (z < nodes.n_owned())
        {
          K.for_row(z,
                    [&](const unsigned int j, const double *block, const bool transposed)
                    { add_row(A, P_0, j, block, transposed, sum); });
          add(T_z); // T^T K T P_0
        }
      for (const auto &spring : A.springs())
      {
        for (const auto &[i, block] : spring.row)
          if (P_0.column[i] != none)
            add_product(block.data(), false, P_0.panels[i], sum[P_0.column[i]]);
        for (const auto &[a, panel] : take(sum))
          add_product(spring.D.data(), false, panel, sum[a]);
        add(spring.row); // R^T D R P_0
      }
      std::map<unsigned int, PanelRow> rows;
      for (const auto &[i, list] : uses)
      {
        for (const auto &[product, block] : list)
          for (const auto &[a, panel] : *product)
            add_product(block, true, panel, sum[a]);
        for (const auto &[a, panel] : take(sum))
          rows[i].emplace(P_0.aggregates[a], panel);
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
      for (const auto &[rank, numbers] : sparse_exchange(nodes.communicator(), outgoing))
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

  void Aggregation::smooth(const BlockCsrMatrix                     &K,
                           const ConstrainedMatrix                  &A,
                           const std::vector<std::array<double, 9>> &D_inverse,
                           const double                              omega)
  {
    const unsigned int               n_owned    = n_nodes_;
    Aggregates                      &aggregates = P_.aggregates;
    Tentative                        P_0        = at_local_nodes(A, tentative_, aggregate_, aggregates.first);
    std::map<unsigned int, PanelRow> constrained;
    if (A.constrained())
      constrained = constrained_rows(A, K, P_0);
    tentative_ = std::vector<double>();

    for (const DoFIndex a : P_0.aggregates)
      if (!aggregates.owned(a))
        aggregates.ghosts.push_back(a);
    for (const auto &[i, row] : constrained)
      for (const auto &[a, panel] : row)
        if (!aggregates.owned(a))
          aggregates.ghosts.push_back(a);
    make_unique_ascending(aggregates.ghosts);
    std::vector<unsigned int> local_column;
    for (const DoFIndex a : P_0.aggregates)
      local_column.push_back(aggregates.local(a));
    for (unsigned int &column : P_0.column)
      column = column == none ? none : local_column[column];
    for (auto &[z, T_row] : P_0.replaced)
      for (auto &[column, panel] : T_row)
        column = local_column[column];
    find_unreplaced(A, P_0);

    SparseRow row;
    row.reinit(aggregates.size());
    P_.start.assign(1, 0);
    // enough but for few nodes; pages that are not touched take no memory, growing and shrinking would take twice as
    // much
    P_.column.reserve(5 * n_owned);
    P_.blocks.reserve(5 * block_size * n_owned + 2);
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      if (!A.replacement(i))
        K.for_row(i,
                  [&](const unsigned int j, const double *block, const bool transposed)
                  { add_row(A, P_0, j, block, transposed, row); });
      if (const auto more = constrained.find(i); more != constrained.end())
        for (const auto &[a, panel] : more->second)
          for (unsigned int c = 0; c < dim; ++c)
            row[aggregates.local(a)].row[c] += panel.row[c];
      const unsigned int own = P_0.column[i];
      if (own != none)
        row[own];
      for (unsigned int k = 0; k < row.columns().size(); ++k)
      {
        const unsigned int a = row.columns()[k];
        Panel              p{};
        add_product(D_inverse[i].data(), false, row.panel(k), p);
        float block[block_size + 2];
        for (unsigned int c = 0; c < dim; ++c) // in this order: each row overwrites what the one before spilt over
        {
          const auto exact   = a == own ? P_0.panels[i].row[c] - omega * p.row[c] : -omega * p.row[c];
          const auto rounded = __builtin_convertvector(exact, ModePanel::Stored);
          std::memcpy(block + n_modes * c, &rounded, sizeof(rounded));
        }
        if (std::all_of(block, block + block_size, [](const float value) { return value == 0.F; }))
          continue;
        P_.column.push_back(a);
        P_.blocks.insert(P_.blocks.end(), block, block + block_size);
      }
      row.clear();
      P_.start.push_back(P_.column.size());
    }
    P_.blocks.resize(P_.blocks.size() + 2, 0.F); // for load()
  }
} // namespace Nodus
