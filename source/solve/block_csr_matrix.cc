#include "solve/block_csr_matrix.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace Nodus
{
  NodeMap::NodeMap(const dealii::IndexSet &owned, std::vector<DoFIndex> ghosts, const MPI_Comm communicator)
      : communicator_(communicator)
      , start_(1, 0)
      , first_(owned.n_elements() > 0 ? *owned.begin() / dim : 0)
      , n_owned_(owned.n_elements() / dim)
      , ghosts_(std::move(ghosts))
  {
    make_unique_ascending(ghosts_);
    end_of_part_.push_back(ghosts_.size());
    for (const unsigned int n : all_gather(communicator, n_owned_))
      start_.push_back(start_.back() + n);
    make_exchange();
  }

  NodeMap::NodeMap(const NodeMap &base, std::vector<DoFIndex> ghosts)
      : communicator_(base.communicator_)
      , start_(base.start_)
      , first_(base.first_)
      , n_owned_(base.n_owned_)
      , ghosts_(base.ghosts_)
      , end_of_part_(base.end_of_part_)
  {
    make_unique_ascending(ghosts);
    for (const DoFIndex node : ghosts)
      if (base.local(node) == dealii::numbers::invalid_unsigned_int)
        ghosts_.push_back(node);
    end_of_part_.push_back(ghosts_.size());
    make_exchange();
  }

  void NodeMap::make_exchange()
  {
    exchange_ = GhostExchange::numbered_through(start_, ghosts_, communicator_);
    ghost_values_.resize(dim * ghosts_.size());
  }

  GhostExchange NodeMap::exchange_for(const std::vector<unsigned int> &nodes) const
  {
    std::vector<DoFIndex> ghosts;
    for (const unsigned int i : nodes)
      ghosts.push_back(global(i));
    return GhostExchange::numbered_through(start_, ghosts, communicator_);
  }

  unsigned int NodeMap::local(const DoFIndex node) const
  {
    if (node >= first_ && node < first_ + n_owned_)
      return node - first_;
    auto begin = ghosts_.begin();
    for (const unsigned int end_of_part : end_of_part_)
    {
      const auto end   = ghosts_.begin() + end_of_part;
      const auto ghost = std::lower_bound(begin, end, node);
      if (ghost != end && *ghost == node)
        return n_owned_ + (ghost - ghosts_.begin());
      begin = end;
    }
    return dealii::numbers::invalid_unsigned_int;
  }

  std::map<DoFIndex, std::vector<double>>
  NodeMap::ask(const std::vector<DoFIndex> &nodes, const std::function<std::vector<double>(unsigned int)> &answer) const
  {
    std::map<unsigned int, std::vector<DoFIndex>> questions;
    for (const DoFIndex node : nodes)
      questions[owner(node)].push_back(node);
    std::map<unsigned int, std::vector<std::vector<double>>> answers;
    for (const auto &[rank, asked] : sparse_exchange(communicator_, questions))
      for (const DoFIndex node : asked)
        answers[rank].push_back(answer(local(node)));
    std::map<DoFIndex, std::vector<double>> result;
    for (auto &[rank, received] : sparse_exchange(communicator_, answers))
      for (unsigned int k = 0; k < received.size(); ++k)
        result[questions[rank][k]] = received[k];
    return result;
  }

  void BlockCsrMatrix::reinit(std::shared_ptr<const NodeMap>   map,
                              const std::vector<unsigned int> &group_nodes,
                              const std::vector<std::size_t>  &group_end)
  {
    const unsigned int         n_nodes = map->size();
    std::vector<std::uint32_t> start(n_nodes + 1, 0), groups(group_nodes.size()); // the groups of each node
    for (const unsigned int i : group_nodes)
      ++start[i + 1];
    for (unsigned int i = 0; i < n_nodes; ++i)
      start[i + 1] += start[i];
    std::vector<std::uint32_t> next(start);
    for (unsigned int g = 0; g < group_end.size(); ++g)
      for (std::size_t k = g > 0 ? group_end[g - 1] : 0; k < group_end[g]; ++k)
        groups[next[group_nodes[k]]++] = g;
    reinit(std::move(map),
           [&](const std::uint32_t i, std::vector<std::uint32_t> &columns)
           {
             for (std::uint32_t n = start[i]; n < start[i + 1]; ++n)
               for (std::size_t k = groups[n] > 0 ? group_end[groups[n] - 1] : 0; k < group_end[groups[n]]; ++k)
                 if (group_nodes[k] > i)
                   columns.push_back(group_nodes[k]);
           });
  }

  void
  BlockCsrMatrix::reinit(std::shared_ptr<const NodeMap>                                                 map,
                         const std::function<void(std::uint32_t, std::vector<std::uint32_t> &columns)> &add_columns)
  {
    map_                       = std::move(map);
    const unsigned int n_owned = map_->n_owned();
    auto               pattern = std::make_shared<NodePattern>();
    NodePattern       &p       = *pattern;
    p.start.assign(1, 0);
    std::vector<std::uint32_t> row;
    p.lower_start.assign(map_->size() + 1, 0);
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      row.assign(1, i);
      add_columns(i, row);
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
      p.ghosts.push_back(p.start.back() + (std::lower_bound(row.begin(), row.end(), n_owned) - row.begin()));
      p.column.insert(p.column.end(), row.begin(), row.end());
      p.start.push_back(p.column.size());
      if (p.ghosts.back() < p.start.back())
        p.interface.push_back(i);
      for (std::uint32_t k = p.start[i] + 1; k < p.start[i + 1]; ++k)
        ++p.lower_start[p.column[k] + 1];
    }
    p.column.shrink_to_fit();
    if (p.column.size() >= std::numeric_limits<std::uint32_t>::max() / 2)
      throw SolverFailure("too many couplings for one process: use more processes");

    for (unsigned int i = 0; i < map_->size(); ++i)
      p.lower_start[i + 1] += p.lower_start[i];
    p.lower.resize(p.lower_start.back());
    std::vector<std::uint32_t> next(p.lower_start);
    for (std::uint32_t i = 0; i < n_owned; ++i)
      for (std::uint32_t k = p.start[i] + 1; k < p.start[i + 1]; ++k)
        p.lower[next[p.column[k]]++] = {i, k};
    values_.assign(9 * p.column.size() + 3, 0.);
    pattern_ = std::move(pattern);
  }

  void BlockCsrMatrix::set_zero()
  {
    std::fill(values_.begin(), values_.end(), 0.);
  }

  BlockCsrMatrix::Position BlockCsrMatrix::position(const unsigned int i, const unsigned int j) const
  {
    const unsigned int n_owned = map_->n_owned(), row = std::min(i, j), column = std::max(i, j);
    if (row >= n_owned)
      return Position();
    const auto first = pattern_->column.begin();
    return Position(std::lower_bound(first + pattern_->start[row], first + pattern_->start[row + 1], column) - first,
                    i > j);
  }

  void BlockCsrMatrix::decouple(const std::vector<double> &chosen)
  {
    const NodeValues at = map_->with_ghosts(chosen.data());
    for (unsigned int i = 0; i < map_->n_owned(); ++i)
      for (std::uint32_t k = pattern_->start[i]; k < pattern_->start[i + 1]; ++k)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            if ((at[i][c] != 0. || at[pattern_->column[k]][d] != 0.) && (i != pattern_->column[k] || c != d))
              values_[9 * std::size_t(k) + dim * c + d] = 0.;
  }

  bool BlockCsrMatrix::decoupled(const unsigned int dof) const
  {
    const NodePattern &p = *pattern_;
    const unsigned int i = dof / dim, c = dof % dim;
    const auto         vanishes = [&](const std::size_t k, const unsigned int first, const unsigned int step)
    {
      const double *const entry = values_.data() + 9 * k + first;
      return entry[0] == 0. && entry[step] == 0. && entry[2 * step] == 0.;
    };
    for (unsigned int d = 0; d < dim; ++d)
      if (d != c && diagonal(i)[dim * c + d] != 0.)
        return false;
    for (std::uint32_t k = p.start[i] + 1; k < p.start[i + 1]; ++k)
      if (!vanishes(k, dim * c, 1))
        return false;
    for (std::uint32_t k = p.lower_start[i]; k < p.lower_start[i + 1]; ++k)
      if (!vanishes(p.lower[k].block, c, dim))
        return false;
    return true;
  }

  namespace
  {
    // Rows of a block in vectors of four, the last of which is of the next row: x is zero there.
    typedef double Lanes __attribute__((vector_size(32)));

    template <typename Number>
    Lanes load(const Number *const values)
    {
      typedef Number Stored __attribute__((vector_size(4 * sizeof(Number))));
      Stored         stored;
      std::memcpy(&stored, values, sizeof(Stored));
      return __builtin_convertvector(stored, Lanes);
    }

    struct BlockRows
    {
      Lanes row[dim];

      template <typename Number>
      explicit BlockRows(const Number *const a)
          : row{load(a), load(a + 3), load(a + 6)}
      {
      }
    };
  } // namespace

  // Neighbours' values come while owned nodes are multiplied: ranks that are ahead in turn need not wait for each
  // other.
  template <typename Number>
  void NodePattern::vmult(const Number *const a, double *const y, const double *const x, const NodeMap &nodes) const
  {
    nodes.start_fetch(x);
    multiply_owned(a, y, x);
    add_ghosts(a, y, nodes.finish_fetch());
  }
  template void NodePattern::vmult(const double *, double *, const double *, const NodeMap &) const;
  template void NodePattern::vmult(const float *, double *, const double *, const NodeMap &) const;

  template <typename Number>
  void NodePattern::multiply_owned(const Number *a, double *const y, const double *const x) const
  {
    // Blocks to be fetched ahead: the rows are too short for the hardware to do it in time. Twice as fast from memory.
    constexpr unsigned int ahead   = 128;
    const unsigned int     n_owned = ghosts.size();
    std::fill_n(y, dim * n_owned, 0.);
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      const double *const xi = x + 3 * i;
      const Lanes         x0 = xi[0] - Lanes{}, x1 = xi[1] - Lanes{}, x2 = xi[2] - Lanes{};
      Lanes               sum[3] = {};
      const auto          add    = [&](const std::uint32_t j, const bool both)
      {
        __builtin_prefetch(a + 9 * ahead);
        const Lanes     xj = {x[3 * j], x[3 * j + 1], x[3 * j + 2], 0.};
        const BlockRows block(a);
        for (unsigned int c = 0; c < dim; ++c)
          sum[c] += block.row[c] * xj;
        if (both)
        {
          const Lanes part = block.row[0] * x0 + block.row[1] * x1 + block.row[2] * x2;
          y[3 * j] += part[0];
          y[3 * j + 1] += part[1];
          y[3 * j + 2] += part[2];
        }
        a += 9;
      };
      std::uint32_t k = start[i];
      add(column[k++], false);
      for (; k < ghosts[i]; ++k)
        add(column[k], true);
      a += 9 * std::size_t(start[i + 1] - k);
      for (unsigned int c = 0; c < dim; ++c)
        y[3 * i + c] += sum[c][0] + sum[c][1] + sum[c][2];
    }
  }

  template <typename Number>
  void NodePattern::add_ghosts(const Number *const a, double *const y, const double *const x_ghosts) const
  {
    const unsigned int n_owned = ghosts.size();
    for (const std::uint32_t i : interface)
    {
      Lanes sum[3] = {};
      for (std::uint32_t k = ghosts[i]; k < start[i + 1]; ++k)
      {
        const double *const xj    = x_ghosts + 3 * (column[k] - n_owned);
        const Lanes         value = {xj[0], xj[1], xj[2], 0.};
        const BlockRows     block(a + 9 * std::size_t(k));
        for (unsigned int c = 0; c < dim; ++c)
          sum[c] += block.row[c] * value;
      }
      for (unsigned int c = 0; c < dim; ++c)
        y[3 * i + c] += sum[c][0] + sum[c][1] + sum[c][2];
    }
  }

  std::vector<double> BlockCsrMatrix::diagonal() const
  {
    std::vector<double> result(dim * map_->n_owned());
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] = diagonal(i / dim)[4 * (i % dim)];
    return result;
  }

  double BlockCsrMatrix::largest_diagonal() const
  {
    double largest = 0.;
    for (const double entry : diagonal())
      largest = std::max(largest, std::abs(entry));
    return dealii::Utilities::MPI::max(largest, map_->communicator());
  }

  double BlockCsrMatrix::norm_squared() const
  {
    double             sum = 0.;
    const NodePattern &p   = *pattern_;
    for (unsigned int i = 0; i < map_->n_owned(); ++i)
      for (std::uint32_t k = p.start[i]; k < p.start[i + 1]; ++k)
      {
        double square = 0.;
        for (unsigned int l = 0; l < 9; ++l)
          square += values_[9 * std::size_t(k) + l] * values_[9 * std::size_t(k) + l];
        sum += k > p.start[i] && k < p.ghosts[i] ? 2. * square : square;
      }
    return dealii::Utilities::MPI::sum(sum, map_->communicator());
  }

  std::size_t BlockCsrMatrix::memory_consumption() const
  {
    const NodePattern &p = *pattern_;
    return sizeof(std::uint32_t) * (p.start.size() + p.ghosts.size() + p.column.size() + p.lower_start.size() +
                                    2 * p.lower.size() + p.interface.size()) +
           sizeof(double) * values_.size();
  }
} // namespace Nodus
