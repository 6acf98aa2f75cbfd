#include <nodus/solve/aggregation.h>
#include <nodus/solve/coarse_matrix.h>
#include <nodus/solve/mode_panel.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace Nodus
{
  using ModePanel::add_product;
  using ModePanel::add_transposed_product;
  using ModePanel::load;
  using ModePanel::Modes;
  using ModePanel::none;
  using ModePanel::Panel;
  using ModePanel::SparseRow;

  namespace
  {
    /// Blocks of P to be fetched from memory ahead of their use.
    constexpr unsigned int ahead = 64;
  } // namespace

  Aggregation::Aggregation(const NodeMatrix                         &K,
                           const CorrectedMatrix                    &A,
                           std::vector<double>                       modes,
                           const std::vector<std::array<double, 9>> &D_inverse,
                           const double                              omega)
      : A_(A)
      , nodes_(A.map())
  {
    aggregate(K, modes);
    make_tentative(std::move(modes));
    smooth(K, D_inverse, omega);
    exchange_ = GhostExchange::numbered_through(starts_, ghosts_, nodes_.communicator());
    ghost_values_.resize(n_modes * ghosts_.size());
  }

  /// A node and its neighbours, as long as none of them is taken; the others join a neighbour's aggregate. Bodies do
  /// not mix: they slide on each other. Nodes without modes are prescribed and stay out.
  void Aggregation::aggregate(const NodeMatrix &K, const std::vector<double> &modes)
  {
    const unsigned int n = nodes_.n_owned();
    std::vector<char>  moves(n, 0);
    for (unsigned int m = 0; m < n_modes; ++m)
      for (unsigned int i = 0; i < dim * n; ++i)
        if (modes[m * dim * n + i] != 0.)
          moves[i / dim] = 1;

    aggregate_.assign(n, none);
    const auto for_neighbours = [&](const unsigned int i, const auto &f)
    {
      K.for_row(i,
                [&](const unsigned int j, const double *, const bool)
                {
                  if (j < n && j != i && moves[j])
                    f(j);
                });
    };
    const auto start = [&](const unsigned int i)
    {
      aggregate_[i] = n_aggregates_;
      for_neighbours(i,
                     [&](const unsigned int j)
                     {
                       if (aggregate_[j] == none)
                         aggregate_[j] = n_aggregates_;
                     });
      ++n_aggregates_;
    };

    for (unsigned int i = 0; i < n; ++i)
      if (moves[i] && aggregate_[i] == none)
      {
        bool free = true;
        for_neighbours(i, [&](const unsigned int j) { free = free && aggregate_[j] == none; });
        if (free)
          start(i);
      }

    const unsigned int        n_first = n_aggregates_;
    std::vector<unsigned int> size(n_first, 0);
    for (const unsigned int a : aggregate_)
      if (a != none)
        ++size[a];
    std::vector<unsigned int> joined;
    for (unsigned int i = 0; i < n; ++i)
      if (moves[i] && aggregate_[i] == none)
      {
        unsigned int best = none;
        for_neighbours(i,
                       [&](const unsigned int j)
                       {
                         const unsigned int a = aggregate_[j];
                         if (a < n_first && (best == none || size[a] < size[best]))
                           best = a;
                       });
        if (best == none)
          continue;
        // not to be seen by the nodes that follow: aggregates would grow long
        joined.push_back(i);
        aggregate_[i] = n_first + best;
        ++size[best];
      }
    for (const unsigned int i : joined)
      aggregate_[i] -= n_first;

    for (unsigned int i = 0; i < n; ++i)
      if (moves[i] && aggregate_[i] == none)
        start(i);

    starts_.assign(1, 0);
    for (const unsigned int n_there : dealii::Utilities::MPI::all_gather(nodes_.communicator(), n_aggregates_))
      starts_.push_back(starts_.back() + n_there);
    first_ = starts_[dealii::Utilities::MPI::this_mpi_process(nodes_.communicator())];
  }

  /// Gram-Schmidt on the modes of each aggregate; what it takes off are the modes in the coarse unknowns.
  void Aggregation::make_tentative(std::vector<double> modes)
  {
    const unsigned int                     n = dim * nodes_.n_owned(), n_coarse = n_modes * n_aggregates_;
    std::vector<std::vector<unsigned int>> dofs(n_aggregates_);
    for (unsigned int i = 0; i < n; ++i)
      if (aggregate_[i / dim] != none)
        dofs[aggregate_[i / dim]].push_back(i);
    tentative_ = std::move(modes);
    coarse_modes_.assign(std::max(1U, n_modes * n_coarse), 0.);
    for (unsigned int a = 0; a < n_aggregates_; ++a)
    {
      const auto product = [&](const unsigned int k, const unsigned int l)
      {
        double sum = 0.;
        for (const unsigned int i : dofs[a])
          sum += tentative_[k * n + i] * tentative_[l * n + i];
        return sum;
      };
      for (unsigned int m = 0; m < n_modes; ++m)
      {
        const double before = std::sqrt(product(m, m));
        for (unsigned int pass = 0; pass < 2; ++pass)
          for (unsigned int k = 0; k < m; ++k)
          {
            const double factor = product(k, m);
            coarse_modes_[m * n_coarse + n_modes * a + k] += factor;
            for (const unsigned int i : dofs[a])
              tentative_[m * n + i] -= factor * tentative_[k * n + i];
          }
        const double norm = std::sqrt(product(m, m)), scale = norm > 1e-8 * before ? 1. / norm : 0.;
        for (const unsigned int i : dofs[a])
          tentative_[m * n + i] *= scale;
        coarse_modes_[m * n_coarse + n_modes * a + m] = scale > 0. ? norm : 0.;
      }
    }
  }

  void Aggregation::smooth(const NodeMatrix &K, const std::vector<std::array<double, 9>> &D_inverse, const double omega)
  {
    // aggregates and modes at all local nodes
    const unsigned int n_owned = nodes_.n_owned(), n = nodes_.size();
    std::vector<Panel> panels(n, Panel{});
    for (unsigned int m = 0; m < n_modes; ++m)
    {
      const NodeValues mode = nodes_.with_ghosts(tentative_.data() + m * dim * n_owned);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int c = 0; c < dim; ++c)
          panels[i].row[c][m] = mode[i][c];
    }
    std::vector<double> numbers(dim * n_owned + 1, -1.);
    for (unsigned int i = 0; i < n_owned; ++i)
      if (aggregate_[i] != none)
        numbers[dim * i] = first_ + aggregate_[i];
    const NodeValues number = nodes_.with_ghosts(numbers.data());
    for (unsigned int i = n_owned; i < n; ++i)
      if (*number[i] >= 0.)
        ghosts_.push_back(static_cast<DoFIndex>(*number[i]));
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
    aggregate_.resize(n, none);
    for (unsigned int i = n_owned; i < n; ++i)
      if (*number[i] >= 0.)
        aggregate_[i] =
            n_aggregates_ + (std::lower_bound(ghosts_.begin(), ghosts_.end(), *number[i]) - ghosts_.begin());
    tentative_ = std::vector<double>();

    SparseRow row;
    row.reinit(n_aggregates_ + ghosts_.size());
    start_.assign(1, 0);
    // enough but for few nodes; pages that are not touched take no memory, growing and shrinking would take twice as
    // much
    column_.reserve(5 * n_owned);
    blocks_.reserve(5 * block_size * n_owned + 2);
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      A_.for_row(K,
                 i,
                 [&](const unsigned int j, const double *block, const bool transposed)
                 {
                   if (aggregate_[j] != none)
                     add_product(block, transposed, panels[j], row[aggregate_[j]]);
                 });
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
          const auto exact   = a == aggregate_[i] ? panels[i].row[c] - omega * p.row[c] : -omega * p.row[c];
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

  std::unique_ptr<NodeMatrix> Aggregation::make_coarse_matrix(const NodeMatrix &K) const
  {
    // columns of A P: aggregates in the rows of P of all local nodes
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
      if ((other < first_ || other >= first_ + n_aggregates_) &&
          !std::binary_search(ghosts_.begin(), ghosts_.end(), other))
        columns.push_back(other);
    const auto column = [&](const DoFIndex global) -> unsigned int
    {
      if (global >= first_ && global < first_ + n_aggregates_)
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

    std::vector<CoarseRow> rows(n_known);
    SparseRow              product;
    product.reinit(columns.size());
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      if (start_[i] == start_[i + 1])
        continue;
      A_.for_row(K,
                 i,
                 [&](const unsigned int j, const double *block, const bool transposed)
                 {
                   if (j < n_owned)
                     for (std::uint32_t k = start_[j]; k < start_[j + 1]; ++k)
                       add_product(block, transposed, load(&blocks_[block_size * std::size_t(k)]), product[column_[k]]);
                   else
                     for (std::size_t k = ghost_start[j - n_owned]; k < ghost_start[j - n_owned + 1]; ++k)
                       add_product(block, transposed, load(&ghost_blocks[block_size * k]), product[ghost_column[k]]);
                 });
      for (unsigned int l = 0; l < product.columns().size(); ++l)
      {
        const Panel   &panel    = product.panel(l);
        const DoFIndex global   = columns[product.columns()[l]];
        const bool     is_owned = product.columns()[l] < n_aggregates_;
        for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
          if (!(is_owned && column_[k] < n_aggregates_ && column_[k] > product.columns()[l])) // symmetric
            add_transposed_product(&blocks_[block_size * std::size_t(k)], panel, rows[column_[k]][global]);
      }
      product.clear();
    }
    return Nodus::make_coarse_matrix(std::move(rows), starts_, ghosts_, nodes_.communicator());
  }

  void Aggregation::restrict_to(double *const coarse, const double *const fine) const
  {
    std::fill_n(coarse, n_modes * n_aggregates_, 0.);
    std::fill(ghost_values_.begin(), ghost_values_.end(), 0.);
    double *const ghosts = ghost_values_.data();
    for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
      {
        const float *const p = blocks_.data() + block_size * std::size_t(k);
        __builtin_prefetch(p + block_size * ahead);
        const std::uint32_t a      = column_[k];
        double *const       values = a < n_aggregates_ ? coarse + n_modes * a : ghosts + n_modes * (a - n_aggregates_);
        Modes               sum    = Modes::load(values);
        for (unsigned int c = 0; c < dim; ++c)
          sum.add_product(Modes::load(p + n_modes * c), fine[dim * i + c]);
        sum.store(values);
      }
    exchange_.add(ghosts, coarse, n_modes);
  }

  void Aggregation::add_prolongation(double *const fine, const double *const coarse) const
  {
    exchange_.fetch(coarse, ghost_values_.data(), n_modes);
    const double *const ghosts = ghost_values_.data();
    for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
    {
      Modes sum[dim] = {};
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
      {
        const float *const p = blocks_.data() + block_size * std::size_t(k);
        __builtin_prefetch(p + block_size * ahead);
        const std::uint32_t a = column_[k];
        const Modes x = Modes::load(a < n_aggregates_ ? coarse + n_modes * a : ghosts + n_modes * (a - n_aggregates_));
        for (unsigned int c = 0; c < dim; ++c)
          sum[c].add_product(Modes::load(p + n_modes * c), x);
      }
      for (unsigned int c = 0; c < dim; ++c)
        fine[dim * i + c] += sum[c].sum();
    }
  }
} // namespace Nodus
