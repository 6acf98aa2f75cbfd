#ifndef nodus_run_nodal_state_h
#define nodus_run_nodal_state_h

#include "run/contact_problem_implementation.h"

#include <array>
#include <tuple>

namespace Nodus
{
  /// Numbers of a site: its status record, the force on the slave and the jump of the displacement there.
  constexpr unsigned int n_status = std::tuple_size<Status::Record>::value, n_site = n_status + 2 * dim;

  /// Numbers of a slave node: those of the site, lambda, Lambda (two components, or a vector in space), the area that
  /// they refer to and the two tangents of the slip. They travel as vectors like the displacement, three in each, zeros
  /// at the end.
  constexpr unsigned int n_node_vectors = (n_site + 5 + 2 * dim + dim - 1) / dim;
  using NodeState                       = std::array<double, dim * n_node_vectors>;
  /// Vectors of all nodes, before those: displacement, reactions to be released, applied forces.
  constexpr unsigned int n_displacement_vectors = 3;

  inline SiteState site_state(const Status::Record &record, const Vector3 &force, const Vector3 &jump)
  {
    SiteState state;
    std::copy(record.begin(), record.end(), state.begin());
    std::copy_n(jump.begin_raw(), dim, std::copy_n(force.begin_raw(), dim, state.begin() + n_status));
    return state;
  }
} // namespace Nodus

#endif
