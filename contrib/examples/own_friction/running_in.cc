// Surfaces that run in: Coulomb's friction with a coefficient that falls from its first to its last value with the way
// w that they have rubbed,
//   tau = (mu_e + (mu_0 - mu_e) exp(-w/l)) p,
// and a layer of asperities that stiffens under pressure, p = p_0 (d/d_0 + (d/d_0)^2).

#include <nodus/plugins/friction_law.h>
#include <nodus/plugins/pressure_gap_law.h>

#include <deal.II/base/parameter_handler.h>

#include <cmath>

class RunningIn : public Nodus::FrictionLaw
{
public:
  using State = std::array<double, Nodus::FrictionPoint::max_state>;

  double limit(const Nodus::FrictionPoint &point) const override
  {
    return coefficient(point) * point.pressure;
  }
  double limit_by_pressure(const Nodus::FrictionPoint &point) const override
  {
    return coefficient(point);
  }

  // The state is the way w, which begins with 0.
  State next_state(const Nodus::FrictionPoint &point, const double duration) const override
  {
    State state = point.state;
    state[0] += point.rate * duration;
    return state;
  }

  void add_parameters(dealii::ParameterHandler &prm) override
  {
    prm.add_parameter("First coefficient", first_, "Coefficient of new surfaces [-], >= 0.");
    prm.add_parameter("Last coefficient", last_, "Coefficient of surfaces that have run in [-], >= 0.");
    prm.add_parameter("Running-in length", length_, "Way after which a part 1/e of the difference is left [length].");
  }
  void initialize() override
  {
    if (!(first_ >= 0. && last_ >= 0. && length_ > 0.))
      throw Nodus::InputError("First and Last coefficient must be >= 0, Running-in length > 0");
  }

private:
  double coefficient(const Nodus::FrictionPoint &point) const
  {
    return last_ + (first_ - last_) * std::exp(-point.state[0] / length_);
  }

  double first_ = 0., last_ = 0., length_ = 0.;
};

class Asperities : public Nodus::PressureGapLaw
{
public:
  double overclosure(const double pressure) const override
  {
    return height_ * (std::sqrt(0.25 + pressure / pressure_) - 0.5);
  }
  double compliance(const double pressure) const override
  {
    return 0.5 * height_ / pressure_ / std::sqrt(0.25 + pressure / pressure_);
  }

  void add_parameters(dealii::ParameterHandler &prm) override
  {
    prm.add_parameter("Height", height_, "Length d_0 [length], > 0.");
    prm.add_parameter("Pressure", pressure_, "Pressure p_0, half of that at d_0 [pressure], > 0.");
  }
  void initialize() override
  {
    if (!(height_ > 0. && pressure_ > 0.))
      throw Nodus::InputError("Height and Pressure must be > 0");
  }

private:
  double height_ = 0., pressure_ = 0.;
};

NODUS_REGISTER_FRICTION(RunningIn, "running in", "Coulomb's law whose coefficient falls with the way rubbed.");
NODUS_REGISTER_PRESSURE_GAP(Asperities, "asperities", "A rough layer, p = p_0 (d/d_0 + (d/d_0)^2).");
