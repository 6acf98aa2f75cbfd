#ifndef nodus_run_stability_h
#define nodus_run_stability_h

#include "run/equilibrium.h"
#include "solve/direct_solver.h"

#include <memory>

namespace Nodus
{
  /// Whether the equilibrium at hand is stable: no motion lowers the energy. The stiffness of a motion z is measured
  /// against what dashpots of rate 1 resist it with (eq. B5), z K z / z B z.
  class Stability
  {
  public:
    /// Both outlive it.
    Stability(const Model &model, Equilibrium &equilibrium);

    /// The mesh is a new one.
    void begin_on_mesh();

    /// Follows the softest motion from increment to increment by inverse iteration with the factors of the last system
    /// (eq. Y1). @returns whether its stiffness is negative; false where the last system was not factorised.
    /// Collective.
    bool follow();

    /// That motion, scaled to a largest entry of 1.
    const Vector &mode() const
    {
      return mode_;
    }

    /// Negative eigenvalues of the stiffness at the state at hand, the contact kept as it is, with dashpots of @p rate
    /// (eq. Y2). Collective. @throws SolverFailure
    unsigned int n_unstable(double rate = 0.);
    /// Whether the system is small enough to be factorised for that.
    bool can_count() const;
    /// Gives the memory of the factors back.
    void release()
    {
      solver_.reset();
    }

  private:
    void start();

    const Model                  &model_;
    Equilibrium                  &equilibrium_;
    std::unique_ptr<DirectSolver> solver_;
    Vector                        mode_;
  };
} // namespace Nodus

#endif
