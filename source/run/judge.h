#ifndef nodus_run_judge_h
#define nodus_run_judge_h

#include "contact/free_motions.h"
#include "contact/intrusion.h"
#include "output/verdict.h"
#include "run/equilibrium.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// Measures a state before it is committed, without what the loops that found it worked with: forces of the bodies
  /// are integrated anew, the surfaces are paired anew by a contact interface of its own, and how far they are inside
  /// each other is found from the faces alone (theory section 34).
  class Judge
  {
  public:
    /// All outlive it.
    Judge(const Model &model, const States &states, const Equilibrium &equilibrium);

    /// The mesh has changed.
    void begin_on_mesh();
    /// Of the state at hand at the end of the increment at hand. @p rest: whether a geometry loop has left something
    /// out of balance, and said so (IncrementLoops::rest()). Collective.
    Verdict judge(double rest = 0.);
    /// How deep a second pass of a pair lets master nodes come: half of what is tolerated where there is contact,
    /// behind what facets of the state that was judged last overlap by without a fault [length]. Collective.
    double clearance(unsigned int pair) const;
    /// Of the state that was judged last.
    const InnerEnergy &inner_energy() const
    {
      return inner_energy_;
    }

  private:
    void   set_up();
    void   pair_anew();
    double tolerance(double of_newton) const;
    void   measure_numbers(Verdict &verdict) const;
    void   measure_contact(Verdict &verdict);
    void   measure_pairs(Verdict &verdict) const;
    void   measure_forces(Verdict &verdict);
    void   measure_held(Verdict &verdict) const;
    void   measure_intrusion(Verdict &verdict);

    std::vector<Status::Violation> deepest_points() const;

    const Model                      &model_;
    const States                     &states_;
    const Equilibrium                &equilibrium_;
    InterfaceState                    interface_state_;
    std::unique_ptr<const OwnedNodes> nodes_;   ///< of this mesh
    std::unique_ptr<ContactInterface> contact_; ///< of this mesh, paired at the state that is judged
    BlockVector                       unknowns_;
    std::vector<double>               larger_face_, smaller_face_; ///< mean ones of the sides of each pair [length]
    double                            length_ = 0.; ///< of the step, that gaps and slips are measured against
    double                            force_  = 0.; ///< that forces are measured against, at least
    double                            rest_   = 0.; ///< of the geometry loop
    InnerEnergy                       inner_energy_;
  };
} // namespace Nodus

#endif
