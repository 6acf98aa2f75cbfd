#include <nodus/solve/node_matrix.h>

#include <deal.II/base/mpi.h>

#include <Epetra_MpiComm.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Nodus
{
  NodeMap::NodeMap(const dealii::IndexSet &owned, std::vector<DoFIndex> ghosts, const MPI_Comm communicator)
      : communicator_(communicator)
      , first_(owned.n_elements() > 0 ? *owned.begin() / dim : 0)
      , n_owned_(owned.n_elements() / dim)
      , ghosts_(std::move(ghosts))
  {
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());

    const Epetra_MpiComm comm(communicator);
    std::vector<int>     columns;
    for (unsigned int i = 0; i < size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        columns.push_back(dim * global(i) + c);
    const int n = owned.size();
    row_map_    = std::make_unique<Epetra_Map>(n, static_cast<int>(dim * n_owned_), 0, comm);
    column_map_ = std::make_unique<Epetra_Map>(-1, static_cast<int>(columns.size()), columns.data(), 0, comm);
    if (dealii::Utilities::MPI::max(ghosts_.empty() ? 0 : 1, communicator) != 0)
    {
      import_ = std::make_unique<Epetra_Import>(*column_map_, *row_map_);
      values_ = std::make_unique<Epetra_MultiVector>(*column_map_, 1, false);
    }
  }

  unsigned int NodeMap::local(const DoFIndex node) const
  {
    if (node >= first_ && node < first_ + n_owned_)
      return node - first_;
    const auto ghost = std::lower_bound(ghosts_.begin(), ghosts_.end(), node);
    return ghost != ghosts_.end() && *ghost == node ? n_owned_ + (ghost - ghosts_.begin())
                                                    : dealii::numbers::invalid_unsigned_int;
  }

  const double *NodeMap::with_ghosts(const double *owned) const
  {
    if (!import_)
      return owned;
    const Epetra_MultiVector view(View, *row_map_, const_cast<double *>(owned), dim * n_owned_, 1);
    values_->Import(view, *import_, Insert);
    return (*values_)[0];
  }

  void NodeMatrix::reinit(std::shared_ptr<const NodeMap>   map,
                          const std::vector<unsigned int> &cell_nodes,
                          const unsigned int               n)
  {
    map_                       = std::move(map);
    const unsigned int n_owned = map_->n_owned(), n_cells = cell_nodes.size() / n;

    // the cells of each node, then row by row the nodes of these cells that the row stores
    std::vector<std::uint32_t> cell_start(map_->size() + 1, 0), cells(cell_nodes.size());
    for (const unsigned int i : cell_nodes)
      ++cell_start[i + 1];
    for (unsigned int i = 0; i < map_->size(); ++i)
      cell_start[i + 1] += cell_start[i];
    std::vector<std::uint32_t> next(cell_start);
    for (unsigned int c = 0; c < n_cells; ++c)
      for (unsigned int a = 0; a < n; ++a)
        cells[next[cell_nodes[c * n + a]]++] = c;

    start_.assign(1, 0);
    ghosts_.clear();
    column_.clear();
    std::vector<std::uint32_t> row, lower_length(n_owned + 1, 0);
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      row.assign(1, i);
      for (std::uint32_t k = cell_start[i]; k < cell_start[i + 1]; ++k)
        for (unsigned int a = 0; a < n; ++a)
          if (const unsigned int j = cell_nodes[cells[k] * n + a]; j > i)
            row.push_back(j);
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
      ghosts_.push_back(start_.back() + (std::lower_bound(row.begin(), row.end(), n_owned) - row.begin()));
      column_.insert(column_.end(), row.begin(), row.end());
      start_.push_back(column_.size());
      for (std::uint32_t k = start_[i] + 1; k < ghosts_[i]; ++k)
        ++lower_length[column_[k] + 1];
    }
    column_.shrink_to_fit();
    if (column_.size() >= std::numeric_limits<std::uint32_t>::max() / 2)
      throw SolverFailure("too many couplings for one process: use more processes");

    lower_start_.assign(lower_length.begin(), lower_length.end());
    for (unsigned int i = 0; i < n_owned; ++i)
      lower_start_[i + 1] += lower_start_[i];
    lower_.resize(lower_start_[n_owned]);
    next.assign(lower_start_.begin(), lower_start_.end());
    for (std::uint32_t i = 0; i < n_owned; ++i)
      for (std::uint32_t k = start_[i] + 1; k < ghosts_[i]; ++k)
        lower_[next[column_[k]]++] = {i, k};
    values_.assign(9 * column_.size(), 0.);
  }

  void NodeMatrix::set_zero()
  {
    std::fill(values_.begin(), values_.end(), 0.);
  }

  NodeMatrix::Position NodeMatrix::position(const unsigned int i, const unsigned int j) const
  {
    const unsigned int n_owned = map_->n_owned(), row = std::min(i, j), column = std::max(i, j);
    if (row >= n_owned)
      return Position();
    const auto found = std::lower_bound(column_.begin() + start_[row], column_.begin() + start_[row + 1], column);
    return Position(found - column_.begin(), i > j);
  }

  bool NodeMatrix::decoupled(const unsigned int dof) const
  {
    const unsigned int i = dof / dim, c = dof % dim;
    bool               zero = true;
    for_row(i,
            [&](const unsigned int j, const double *block, const bool transposed)
            {
              for (unsigned int d = 0; d < dim; ++d)
                zero = zero && ((j == i && c == d) || block[transposed ? 3 * d + c : 3 * c + d] == 0.);
            });
    return zero;
  }

  void NodeMatrix::vmult(double *const y, const double *const x_owned) const
  {
    const double *const x       = map_->with_ghosts(x_owned);
    const unsigned int  n_owned = map_->n_owned();
    std::fill_n(y, dim * n_owned, 0.);
    const double        *a      = values_.data();
    const std::uint32_t *column = column_.data();
    for (unsigned int i = 0; i < n_owned; ++i)
    {
      const double  x0 = x[3 * i], x1 = x[3 * i + 1], x2 = x[3 * i + 2];
      double        y0 = a[0] * x0 + a[1] * x1 + a[2] * x2;
      double        y1 = a[3] * x0 + a[4] * x1 + a[5] * x2;
      double        y2 = a[6] * x0 + a[7] * x1 + a[8] * x2;
      std::uint32_t k  = start_[i] + 1;
      a += 9;
      for (; k < ghosts_[i]; ++k, a += 9)
      {
        const double *const xj = x + 3 * column[k];
        double *const       yj = y + 3 * column[k];
        y0 += a[0] * xj[0] + a[1] * xj[1] + a[2] * xj[2];
        y1 += a[3] * xj[0] + a[4] * xj[1] + a[5] * xj[2];
        y2 += a[6] * xj[0] + a[7] * xj[1] + a[8] * xj[2];
        yj[0] += a[0] * x0 + a[3] * x1 + a[6] * x2;
        yj[1] += a[1] * x0 + a[4] * x1 + a[7] * x2;
        yj[2] += a[2] * x0 + a[5] * x1 + a[8] * x2;
      }
      for (; k < start_[i + 1]; ++k, a += 9)
      {
        const double *const xj = x + 3 * column[k];
        y0 += a[0] * xj[0] + a[1] * xj[1] + a[2] * xj[2];
        y1 += a[3] * xj[0] + a[4] * xj[1] + a[5] * xj[2];
        y2 += a[6] * xj[0] + a[7] * xj[1] + a[8] * xj[2];
      }
      y[3 * i] += y0;
      y[3 * i + 1] += y1;
      y[3 * i + 2] += y2;
    }
  }

  std::vector<double> NodeMatrix::diagonal() const
  {
    std::vector<double> result(dim * map_->n_owned());
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] = diagonal(i / dim)[4 * (i % dim)];
    return result;
  }

  double NodeMatrix::largest_diagonal() const
  {
    double largest = 0.;
    for (const double entry : diagonal())
      largest = std::max(largest, std::abs(entry));
    return dealii::Utilities::MPI::max(largest, map_->communicator());
  }

  double NodeMatrix::norm_squared() const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < map_->n_owned(); ++i)
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
      {
        double square = 0.;
        for (unsigned int l = 0; l < 9; ++l)
          square += values_[9 * std::size_t(k) + l] * values_[9 * std::size_t(k) + l];
        sum += k > start_[i] && k < ghosts_[i] ? 2. * square : square;
      }
    return dealii::Utilities::MPI::sum(sum, map_->communicator());
  }

  std::size_t NodeMatrix::memory_consumption() const
  {
    return sizeof(std::uint32_t) * (start_.size() + ghosts_.size() + column_.size() + lower_start_.size()) +
           sizeof(Lower) * lower_.size() + sizeof(double) * values_.size();
  }
} // namespace Nodus
