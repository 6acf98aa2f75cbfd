#ifndef nodus_run_state_vectors_h
#define nodus_run_state_vectors_h

#include "contact/contact_interface.h"
#include "run/state.h"

#include <map>
#include <utility>
#include <vector>

// A State as vectors like the displacement, which checkpoints and new meshes take over, and back. What a slave node
// has besides its displacement travels three numbers to a vector, zeros at all other nodes; pairs whose slave surfaces
// meet have vectors of their own.

namespace Nodus
{
  /// Vectors of all nodes, which come first: all that visit_members() calls nodes().
  unsigned int n_displacement_vectors();
  /// Number of vectors.
  unsigned int n_state_vectors(const ContactSurfaces &surfaces);

  /// Numbers of a contact site: all that visit_members() calls sites().
  unsigned int        n_site_values();
  std::vector<double> site_values(const State &state, unsigned int site);

  /// To the last digit; the states of integration points are not among it.
  std::vector<Vector> exact_vectors(const State &state, const ContactInterface &contact);
  /// Takes back what exact_vectors() gave, and the values of all sites, those of own integration points right. Common
  /// members and histories stay as they are. Collective.
  void take_exact(const std::vector<Vector> &vectors,
                  std::vector<double>        sites,
                  const ContactInterface    &contact,
                  State                     &state);

  /// Friction multipliers are vectors in space, to be interpolated between frames; nodes of the integration point
  /// scheme have the mean of the points around them. Collective.
  std::vector<Vector> interpolable_vectors(const State &state, const ContactInterface &contact);
  /// Takes them on another mesh, where no equilibrium has been found yet: pressures are kept, not forces. Collective.
  void take_interpolated(const std::vector<Vector> &vectors, const ContactInterface &contact, State &state);

  /// A state on its mesh, while contact pairs are added behind those that there are.
  class KeptState
  {
  public:
    KeptState(const State &state, const ContactInterface &contact);
    /// What is of new pairs stays as it is in @p state, and so do common members and histories. Collective.
    void restore(const ContactInterface &contact, State &state) const;

  private:
    using Site = std::pair<bool, DoFIndex>; ///< whether it is a point, and ContactSurfaces::order()

    std::vector<Vector>                 of_nodes_;
    std::map<Site, std::vector<double>> of_sites_; ///< owned ones; of slave nodes their own numbers come behind
  };

  /// What all ranks share, from one state to another.
  void copy_common(const State &from, State &to);
  /// The same as bytes.
  std::vector<char> pack_common(const State &state);
  void              unpack_common(const std::vector<char> &bytes, State &state);
} // namespace Nodus

#endif
