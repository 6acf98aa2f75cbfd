#include <nodus/solve/multigrid.h>

#include <deal.II/base/mpi.h>

#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <limits>

namespace Nodus
{
  std::vector<double> rigid_body_modes(const NodeMatrix &K, const RigidBodyData &data)
  {
    const MPI_Comm    comm = K.map().communicator();
    const std::size_t n    = dim * K.map().n_owned();
    if (dealii::Utilities::MPI::max(data.support_points.size() == n && data.component.size() == n ? 0 : 1, comm) != 0)
      throw SolverFailure("Multigrid: the rigid-body data does not match the displacements of the system.");

    Vector3 centre, extent;
    for (unsigned int d = 0; d < dim; ++d)
    {
      double lower = std::numeric_limits<double>::max(), upper = std::numeric_limits<double>::lowest();
      for (const Point &p : data.support_points)
      {
        lower = std::min(lower, p[d]);
        upper = std::max(upper, p[d]);
      }
      lower     = dealii::Utilities::MPI::min(lower, comm);
      upper     = dealii::Utilities::MPI::max(upper, comm);
      centre[d] = .5 * (lower + upper);
      extent[d] = upper - lower;
    }
    const double length = extent.norm();

    std::vector<double> modes(6 * std::max<std::size_t>(n, 1), 0.);
    for (std::size_t i = 0; i < n; ++i)
      if (!K.decoupled(i))
      {
        const Vector3      x = (data.support_points[i] - Point(centre)) / length;
        const unsigned int c = data.component[i];
        modes[c * n + i]     = 1.;
        // rotation about axis a: e_a x x
        modes[(3 + (c + 1) % 3) * n + i] = x[(c + 2) % 3];
        modes[(3 + (c + 2) % 3) * n + i] = -x[(c + 1) % 3];
      }
    return modes;
  }

  Multigrid::Multigrid(const Epetra_RowMatrix &matrix, std::vector<double> modes, const unsigned int smoother_sweeps)
      : modes_(std::move(modes))
  {
    using AMG = dealii::TrilinosWrappers::PreconditionAMG;
    AMG::AdditionalData data;
    data.elliptic              = true;
    data.smoother_sweeps       = smoother_sweeps;
    data.aggregation_threshold = 0.;
    Teuchos::ParameterList              parameters;
    std::unique_ptr<Epetra_MultiVector> unused;
    data.set_parameters(parameters, unused, matrix);
    parameters.set("PDE equations", 3);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", 6);
    parameters.set("null space: vectors", const_cast<double *>(modes_.data()));
    parameters.set("null space: add default vectors", false);
    multigrid_.initialize(matrix, parameters);
  }
} // namespace Nodus
