#include "solve/direct_solver.h"

#include <deal.II/base/mpi.h>

#include <dmumps_c.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Nodus
{
  namespace
  {
    // MUMPS numbers its control and info entries from 1.
    int &icntl(DMUMPS_STRUC_C &mumps, const unsigned int i)
    {
      return mumps.icntl[i - 1];
    }
    int infog(const DMUMPS_STRUC_C &mumps, const unsigned int i)
    {
      return mumps.infog[i - 1];
    }

    std::string meaning(const DMUMPS_STRUC_C &mumps)
    {
      const std::string detail = std::to_string(infog(mumps, 2));
      switch (infog(mumps, 1))
      {
        case -5:
        case -7:
        case -13:
          return "an allocation failed (" + detail +
                 " entries; negative: in millions): use more ranks or memory, or 'Type = block'";
        case -6:
          return "the matrix is structurally singular (structural rank " + detail + ")";
        case -8:
        case -9:
        case -11:
        case -14:
        case -15:
        case -17:
        case -18:
        case -19:
        case -20:
          return "the working space stayed too small although it was enlarged repeatedly";
        case -10:
          return "the matrix is numerically singular";
        case -51:
        case -52:
          return "the problem exceeds the 32-bit integers of an ordering: use 'Type = block'";
        default:
          return "see the MUMPS users' guide, INFOG(2) = " + detail;
      }
    }

    // The estimate of the working space does not foresee the pivots that are delayed for stability.
    bool asks_for_more_space(const DMUMPS_STRUC_C &mumps)
    {
      const int code = infog(mumps, 1);
      return code == -8 || code == -9 || code == -11 || code == -14 || code == -15 || (code <= -17 && code >= -20);
    }

    /// Of LinearSolver::Report::work, fitted to models of 2000 to 52000 displacements: entries that are gathered and
    /// analysed; those, with assembly of small fronts and substitutions; operations of the elimination.
    constexpr double work_per_analysed_entry = 0.15, work_per_entry = 0.3, work_per_operation = 1. / 12000.;

    double norm(const std::vector<double> &v)
    {
      double sum = 0.;
      for (const double entry : v)
        sum += entry * entry;
      return std::sqrt(sum);
    }
  } // namespace

  struct DirectSolver::Instance
  {
    DMUMPS_STRUC_C mumps{};
    MPI_Comm       communicator;
    bool           analysed = false;

    Instance(const MPI_Comm communicator, const bool symmetric)
        : communicator(communicator)
    {
      mumps.par          = 1; // rank 0 takes part in the factorisation
      mumps.sym          = symmetric ? 2 : 0;
      mumps.comm_fortran = MPI_Comm_c2f(communicator);
      run(-1);
      for (unsigned int i = 1; i <= 4; ++i)
        icntl(mumps, i) = i == 4 ? 0 : -1; // silent
      icntl(mumps, 13) = 1;                // no ScaLAPACK root: it neither counts the inertia nor finds null pivots
      icntl(mumps, 14) = 30;               // per cent of working space above the estimate
      icntl(mumps, 18) = 3;                // distributed entries
      icntl(mumps, 24) = 1;                // null pivots are found, fixed and listed
      mumps.cntl[2]    = 1e-12;            // pivot rows below this times |A| are null; the default misses round-off
    }

    ~Instance()
    {
      int finalised = 0;
      MPI_Finalized(&finalised);
      if (!finalised)
        run(-2);
    }

    Instance(const Instance &)            = delete;
    Instance &operator=(const Instance &) = delete;

    // @returns success, the same on every rank
    bool run(const int job)
    {
      mumps.job = job;
      dmumps_c(&mumps);
      return infog(mumps, 1) >= 0;
    }
  };

  DirectSolver::DirectSolver(const BlockLayout &layout)
      : communicator_(layout.communicator)
      , size_(0)
      , symmetric_(true)
  {
  }

  DirectSolver::~DirectSolver() = default;

  bool DirectSolver::collect_entries(const LinearSystem &system, const FlatVectors &flat)
  {
    // All entries in sequence, those of one place apart.
    const auto for_entries = [&](const auto &f)
    {
      const BlockCsrMatrix &bulk  = system.bulk;
      const NodeMap        &nodes = bulk.map();
      for (unsigned int r = 0; r < nodes.n_owned(); ++r)
        bulk.for_row(r,
                     [&](const unsigned int c, const double *block, const bool transposed)
                     {
                       const DoFIndex row = dim * nodes.global(r), column = dim * nodes.global(c);
                       for (unsigned int i = 0; i < dim; ++i)
                         for (unsigned int j = 0; j < dim; ++j)
                           if (row + i <= column + j || !symmetric_)
                             f(row + i, column + j, block[transposed ? dim * j + i : dim * i + j]);
                     });
      for (const TripletMatrix *part : {&system.contact, &system.variation})
        for (std::size_t k = 0; k < part->value.size(); ++k)
          if (part->row[k] <= part->column[k] || !symmetric_)
            f(part->row[k], part->column[k], part->value[k]);
    };

    // Sorted by rows.
    std::vector<std::size_t> begin(size_ + 1, 0);
    for_entries([&](const DoFIndex i, DoFIndex, double) { ++begin[i + 1]; });
    for (int i = 0; i < size_; ++i)
      begin[i + 1] += begin[i];
    struct Entry
    {
      int    column;
      double value;
    };
    const std::unique_ptr<Entry[]> entries(new Entry[begin[size_]]); // all are written to: no zeros first
    std::vector<std::size_t>       next(begin.begin(), begin.end() - 1);
    bool                           finite = true;
    for_entries(
        [&](const DoFIndex i, const DoFIndex j, const double v)
        {
          const double scaled = v * flat.scale(i) * flat.scale(j);
          finite              = finite && std::isfinite(scaled);
          entries[next[i]++]  = {static_cast<int>(j), scaled};
        });

    // MUMPS adds up entries of one place, but contact has many of them, and it keeps them all.
    std::vector<std::size_t> place(size_, 0); // of each column, from 1; in the present row where it is beyond its first
    std::size_t              n = 0;
    for (int i = 0; i < size_; ++i)
    {
      const std::size_t first = n, end = begin[i + 1];
      for (std::size_t k = begin[i]; k < end; ++k)
        if (const Entry entry = entries[k]; place[entry.column] > first)
          entries[place[entry.column] - 1].value += entry.value;
        else
        {
          entries[n]          = entry;
          place[entry.column] = ++n;
        }
      begin[i] = first;
    }
    begin[size_] = n;

    bool changed = n != value_.size();
    row_.resize(n);
    column_.resize(n);
    value_.resize(n);
    for (int i = 0; i < size_; ++i)
      for (std::size_t k = begin[i]; k < begin[i + 1]; ++k)
      {
        changed    = changed || row_[k] != i + 1 || column_[k] != entries[k].column + 1;
        row_[k]    = i + 1;
        column_[k] = entries[k].column + 1;
        value_[k]  = entries[k].value;
      }
    if (dealii::Utilities::MPI::max(finite ? 0 : 1, communicator_) != 0)
    {
      value_.clear(); // nothing is analysed for this pattern: the next one counts as changed
      throw SolverFailure("Direct solver: the matrix holds a value that is not finite",
                          SolverFailure::Kind::not_finite);
    }
    return dealii::Utilities::MPI::max(changed ? 1 : 0, communicator_) != 0;
  }

  bool DirectSolver::take(const LinearSystem &system, const FlatVectors &flat)
  {
    if (system.layout->size() >= static_cast<DoFIndex>(std::numeric_limits<int>::max()))
      throw SolverFailure("Direct solver: too many unknowns for MUMPS, use 'Type = block'.",
                          SolverFailure::Kind::linear_solver);
    const bool same_size = size_ == static_cast<int>(system.layout->size());
    size_                = system.layout->size();
    if (symmetric_ != system.symmetric)
      instance_.reset(); // MUMPS takes the kind of matrix once
    symmetric_ = system.symmetric;
    return collect_entries(system, flat) || !same_size;
  }

  void DirectSolver::set_up(const bool pattern_changed, const bool with_factors)
  {
    const auto timer = time_set_up();
    if (!instance_)
      instance_ = std::make_unique<Instance>(communicator_, symmetric_);
    DMUMPS_STRUC_C &mumps = instance_->mumps;

    if (pattern_changed)
      coupled_.find(size_, row_, column_, communicator_);
    coupled_.take_diagonal(row_, value_, communicator_);
    mumps.n       = coupled_.size();
    mumps.nnz_loc = static_cast<MUMPS_INT8>(row_.size());
    mumps.irn_loc = coupled_.row.data(); // entries in row 0 count as out of range, and are left out
    mumps.jcn_loc = coupled_.column.data();
    mumps.a_loc   = value_.data();
    if (pattern_changed || !instance_->analysed)
    {
      instance_->analysed = false;
      if (!instance_->run(1))
        give_up();
      instance_->analysed = true;
    }
    if (!with_factors)
      return;

    constexpr unsigned int max_attempts = 6;
    bool                   success      = instance_->run(2);
    for (unsigned int i = 1; i < max_attempts && !success && asks_for_more_space(mumps); ++i)
    {
      icntl(mumps, 14) *= 2;
      success = instance_->run(2);
    }
    if (!success)
      give_up();
  }

  void DirectSolver::give_up(const std::string &where)
  {
    const DMUMPS_STRUC_C &mumps = instance_->mumps;
    const std::string message = "MUMPS error " + std::to_string(infog(mumps, 1)) + where + ": " + meaning(mumps) + ".";
    instance_.reset(); // gives the memory back; the next system starts afresh
    throw SolverFailure("Direct solver: " + message, SolverFailure::Kind::linear_solver);
  }

  double DirectSolver::work(const double n_operations) const
  {
    return work_per_entry * dealii::Utilities::MPI::sum<double>(value_.size(), communicator_) +
           work_per_operation * n_operations;
  }

  DirectSolver::LeastWork DirectSolver::least_work(const LinearSystem &system)
  {
    const double half = dealii::Utilities::MPI::sum<double>(system.bulk.values().size(), system.layout->communicator);
    return {work_per_analysed_entry * (system.symmetric ? half : 2. * half), work_per_entry * half};
  }

  double DirectSolver::estimate(const LinearSystem &system)
  {
    set_up(take(system, FlatVectors(system)), false);
    return work(instance_->mumps.rinfog[0]);
  }

  void DirectSolver::apply_inverse(std::vector<double> &x)
  {
    DMUMPS_STRUC_C     &mumps = instance_->mumps;
    std::vector<double> y     = coupled_.part(x);
    mumps.nrhs                = 1;
    mumps.lrhs                = coupled_.size();
    mumps.rhs                 = y.data(); // only read and written on rank 0
    if (!instance_->run(3))
      give_up(" in the substitution");
    coupled_.solve(y, x);
    MPI_Bcast(x.data(), size_, MPI_DOUBLE, 0, communicator_);
  }

  std::vector<double> DirectSolver::residual(const std::vector<double> &b, const std::vector<double> &x) const
  {
    std::vector<double> r(size_, 0.);
    for (std::size_t k = 0; k < value_.size(); ++k)
    {
      const int i = row_[k] - 1, j = column_[k] - 1;
      r[i] -= value_[k] * x[j];
      if (symmetric_ && i != j)
        r[j] -= value_[k] * x[i];
    }
    dealii::Utilities::MPI::sum(r, communicator_, r);
    for (int i = 0; i < size_; ++i)
      r[i] += b[i];
    return r;
  }

  LinearSolver::Report DirectSolver::solve(const LinearSystem                     &system,
                                           const std::vector<const BlockVector *> &rhs,
                                           std::vector<BlockVector>               &solutions,
                                           double)
  {
    const FlatVectors flat(system);
    set_up(take(system, flat), true);

    Report report;
    solutions.resize(rhs.size());
    for (unsigned int n = 0; n < rhs.size(); ++n)
    {
      const double relative_residual = substitute(flat, *rhs[n], solutions[n]);
      if (n == 0)
        report.relative_residual = relative_residual;
    }

    DMUMPS_STRUC_C &mumps = instance_->mumps;
    report.work           = work(mumps.rinfog[2]);
    if (symmetric_)
      report.negative_pivots = infog(mumps, 12) + coupled_.n_negative();
    std::vector<int> null_pivots(infog(mumps, 28));
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0)
      std::copy_n(mumps.pivnul_list, null_pivots.size(), null_pivots.begin());
    MPI_Bcast(null_pivots.data(), static_cast<int>(null_pivots.size()), MPI_INT, 0, communicator_);
    for (const int i : null_pivots)
      report.null_pivots.push_back(coupled_.unknown(i));
    for (const int i : coupled_.null_pivots())
      report.null_pivots.push_back(i);
    std::sort(report.null_pivots.begin(), report.null_pivots.end());
    return report;
  }

  double DirectSolver::substitute(const FlatVectors &flat, const BlockVector &rhs, BlockVector &solution)
  {
    std::vector<double> b      = flat.flatten(rhs);
    const double        norm_b = norm(b);
    if (!std::isfinite(norm_b))
      throw SolverFailure("Direct solver: the right-hand side holds a value that is not finite",
                          SolverFailure::Kind::not_finite);

    std::vector<double> x = b;
    apply_inverse(x);

    // Two steps of refinement at most, kept only where they help (they cannot on an inconsistent singular system).
    std::vector<double> r = residual(b, x);
    for (unsigned int step = 0; step < 2 && norm(r) > 1e-14 * norm_b; ++step)
    {
      std::vector<double> refined = r;
      apply_inverse(refined);
      for (int i = 0; i < size_; ++i)
        refined[i] += x[i];
      std::vector<double> refined_residual = residual(b, refined);
      if (!(norm(refined_residual) < norm(r)))
        break;
      x.swap(refined);
      r.swap(refined_residual);
    }
    if (!std::isfinite(norm(r)))
      throw SolverFailure("Direct solver: the solution is not finite, the matrix is numerically singular",
                          SolverFailure::Kind::linear_solver);

    flat.unflatten(x, solution);
    for (int i = 0; i < size_; ++i) // back to the units of the caller
    {
      r[i] /= flat.scale(i);
      b[i] /= flat.scale(i);
    }
    return norm(r) / (norm_b > 0. ? norm(b) : 1.);
  }

  bool DirectSolver::solve_again(const LinearSystem &system, const BlockVector &rhs, BlockVector &solution)
  {
    if (!instance_ || size_ != static_cast<int>(system.layout->size()))
      return false;
    const FlatVectors   flat(system);
    std::vector<double> x = flat.flatten(rhs);
    apply_inverse(x);
    flat.unflatten(x, solution);
    return true;
  }
} // namespace Nodus
