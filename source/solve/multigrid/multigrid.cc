#include "solve/multigrid/multigrid.h"
#include "parallel/wait_for_all.h"
#include "solve/multigrid/coarse_solver.h"
#include "solve/multigrid/rigid_motions.h"

#include <deal.II/base/mpi.h>

namespace Nodus
{
  namespace
  {
    /// Unknowns of the level that is solved exactly.
    constexpr unsigned int largest_coarsest = 400;

    unsigned int size(const BlockCsrMatrix &matrix)
    {
      return dim * matrix.map().n_global();
    }

    /// Modes vanish where nothing but the diagonal of @p K couples.
    void clear_decoupled(const BlockCsrMatrix &K, std::vector<double> &modes)
    {
      const std::size_t n = dim * K.map().n_owned();
      for (std::size_t i = 0; i < n; ++i)
        if (K.decoupled(i))
          for (unsigned int m = 0; m < Transfer::n_modes; ++m)
            modes[m * n + i] = 0.;
    }
  } // namespace

  std::vector<double> rigid_body_modes(const BlockCsrMatrix &K, const std::vector<Point> &node_positions)
  {
    const MPI_Comm    comm = K.map().communicator();
    const std::size_t n    = dim * K.map().n_owned();
    wait_for_all(comm); // for those that have corrections at the contact
    if (dealii::Utilities::MPI::max(dim * node_positions.size() == n ? 0 : 1, comm) != 0)
      throw SolverFailure("Multigrid: the positions of the nodes do not match the displacements of the system.");

    const RigidMotions  motions(node_positions, comm);
    std::vector<double> modes(6 * std::max<std::size_t>(n, 1), 0.);
    for (std::size_t i = 0; i < n / dim; ++i)
      motions.set(node_positions[i], modes.data() + dim * i, n);
    clear_decoupled(K, modes);
    return modes;
  }

  Multigrid::Multigrid(const BlockCsrMatrix    &K,
                       const ConstrainedMatrix &A,
                       std::vector<double>      modes,
                       const DisplacementNodes &nodes,
                       unsigned int             smoother_sweeps)
  {
    const bool                      corners = !nodes.corners.pairs.empty();
    std::unique_ptr<BlockCsrMatrix> matrix =
        add_level(K, nullptr, &A, modes, corners ? &nodes : nullptr, smoother_sweeps);
    smoother_sweeps *= 2; // the coarse levels cost little
    bool stalls = false;
    while (!stalls && size(*matrix) > largest_coarsest)
    {
      auto                           copy     = std::make_unique<ConstrainedMatrix>(*matrix);
      const ConstrainedMatrix *const A_coarse = copy.get();
      auto next = add_level(*matrix, std::move(copy), A_coarse, modes, nullptr, smoother_sweeps);
      stalls    = size(*next) > .5 * size(*matrix);
      matrix    = std::move(next);
    }

    coarsest_ = std::make_unique<CoarseSolver>(*matrix);
  }

  /// Takes the modes of the level and gives those of the next one, whose matrix it returns.
  std::unique_ptr<BlockCsrMatrix> Multigrid::add_level(const BlockCsrMatrix              &K,
                                                       std::unique_ptr<ConstrainedMatrix> owned,
                                                       const ConstrainedMatrix           *A,
                                                       std::vector<double>               &modes,
                                                       const DisplacementNodes           *corners,
                                                       const unsigned int                 smoother_sweeps)
  {
    Level level;
    level.matrix = std::move(owned);
    level.level  = std::make_unique<MultigridLevel>(K, *A, std::move(modes), corners, smoother_sweeps);
    std::unique_ptr<BlockCsrMatrix> next = level.level->transfer().make_coarse_matrix(K, *A);
    modes                                = std::move(level.level->transfer().modes());
    clear_decoupled(*next, modes);
    for (auto *v : {&level.coarse_residual, &level.coarse_correction})
      v->resize(dim * next->map().n_owned());
    levels_.push_back(std::move(level));
    return next;
  }

  void Multigrid::vmult(Vector &dst, const Vector &src) const
  {
    const auto x = [&](const unsigned int l) { return l == 0 ? dst.begin() : levels_[l - 1].coarse_correction.data(); };
    const auto b = [&](const unsigned int l) { return l == 0 ? src.begin() : levels_[l - 1].coarse_residual.data(); };
    for (unsigned int l = 0; l < levels_.size(); ++l)
      levels_[l].level->pre_smooth(x(l), b(l), levels_[l].coarse_residual.data());

    const Level &last = levels_.back();
    coarsest_->solve(last.coarse_residual, last.coarse_correction);

    for (unsigned int l = levels_.size(); l-- > 0;)
      levels_[l].level->post_smooth(x(l), b(l), levels_[l].coarse_correction.data());
  }
} // namespace Nodus
