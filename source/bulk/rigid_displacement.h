#ifndef nodus_bulk_rigid_displacement_h
#define nodus_bulk_rigid_displacement_h

#include "rigid/prescribed_motion.h"

#include <deal.II/base/function.h>

#include <string>
#include <vector>

namespace Nodus
{
  /// Displacement of points that move as those of a rigid body, in some components.
  class RigidDisplacement : public dealii::Function<dim>
  {
  public:
    /// @p label: for messages. @throws InputError
    RigidDisplacement(const PrescribedMotionParameters &parameters,
                      const std::vector<unsigned int>  &components,
                      const std::string                &label)
        : dealii::Function<dim>(components.size())
        , components_(components)
        , motion_(parameters, Point(), Vector3(), label)
        , now_(motion_.at(0.))
    {
    }

    /// @throws InputError, on every rank, where the motion is not a number.
    void set_time(const double t) override
    {
      dealii::Function<dim>::set_time(t);
      now_ = motion_.at(t);
    }
    double value(const Point &X, const unsigned int entry) const override
    {
      return (now_.to(X) - X)[components_[entry]];
    }

  private:
    std::vector<unsigned int> components_;
    PrescribedMotion          motion_;
    Placement                 now_;
  };
} // namespace Nodus

#endif
