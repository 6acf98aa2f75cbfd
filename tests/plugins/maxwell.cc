// A law of the program's own with a memory and a rate, against its closed form: a confined block on a rigid plane is
// compressed with a constant rate of the strain, then held. Both degrees, with mean dilatation, on a mesh that is
// refined on the way, after a restart on another number of ranks; what does not fit the checkpoint is noticed.

#include "maxwell.h"
#include "../cases.h"
#include <nodus/plugins/error_indicator.h>

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  constexpr double E = 10., nu = 0.3, share = 0.8, tau = 0.6, largest_strain = 0.2;

  /// Refines the lower half.
  class LowerHalf : public ErrorIndicator
  {
  public:
    double error(const Cell &) const override
    {
      return 0.;
    }
    bool refine(const Cell &cell) const override
    {
      return cell.centre[2] < 0.5;
    }
  };

  std::shared_ptr<Maxwell> maxwell()
  {
    auto law    = std::make_shared<Maxwell>();
    law->share_ = share;
    law->tau_   = tau;
    law->set_elastic_constants(E, nu);
    law->initialize();
    return law;
  }

  /// On the block at time t.
  double closed_form(const double t)
  {
    const double strain = -largest_strain * std::min(t, 1.);
    const double elastic =
        -largest_strain * tau * -std::expm1(-std::min(t, 1.) / tau) * std::exp(-std::max(0., t - 1.) / tau);
    const double modulus = E * (1. - nu) / ((1. + nu) * (1. - 2. * nu));
    return -std::sqrt(1. + 2. * strain) * modulus * (strain + share * elastic);
  }

  Parameters block()
  {
    Parameters p;
    p.bodies                                = {box("block", "2,3,2", {0, 0, 0}, {1, 1, 1}, 0., 0.3)};
    p.bodies[0].material.law                = MaterialParameters::Law::own;
    p.bodies[0].material.own_law            = {maxwell(), "Maxwell"};
    p.boundary_conditions                   = {hold("sides x", region(1, {x_minus, x_plus}), {0}),
                                               hold("sides y", region(1, {y_minus, y_plus}), {1}),
                                               drive("stamp", region(1, {z_plus}), 2, "sqrt(1-0.4*min(t,1))-1")};
    p.contact_pairs                         = {pair(region(1, {z_minus}), RegionParameters())};
    p.contact_pairs[0].master_surface.shape = MasterSurfaceParameters::Shape::plane;
    p.contact_pairs[0].master_surface.axis  = Vector3({0., 0., 1.});
    p.load_stepping.interval_ends           = {1, 3};
    p.load_stepping.increments              = {3, 4};
    p.newton.force_tolerance                = 1e-11;
    p.output.results_folder                 = "maxwell_results";
    p.output.write_vtu                      = false;
    p.output.checkpoint_interval            = 0;
    return p;
  }

  struct Run
  {
    std::vector<double> forces;
    double              deviation = 0.; ///< from the closed form, relative
    unsigned int        sites     = 0;
  };

  Run follow(const Parameters &p, const MPI_Comm communicator = world(), const bool restart = false)
  {
    Run result;
    if (communicator == MPI_COMM_NULL)
      return result;
    ContactProblem problem(p, communicator, log());
    if (restart)
      problem.restart();
    problem.on_increment(
        [&](const unsigned int, const double t)
        {
          const auto &r = problem.contact_resultants()[0];
          result.forces.push_back(r.slave_force[2]);
          result.deviation = std::max(result.deviation, std::abs(r.slave_force[2] / closed_form(t) - 1.));
          result.sites     = r.open + r.slip + r.stick;
        });
    problem.run();
    return result;
  }

  std::string refusal(const Parameters &p, const bool restart = false)
  {
    try
    {
      follow(p, world(), restart);
    }
    catch (const InputError &error)
    {
      return error.what();
    }
    return "none: NO";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  MPI_Comm                                 first_rank;
  MPI_Comm_split(world(), root() ? 0 : MPI_UNDEFINED, 0, &first_rank);

  for (const unsigned int degree : {1, 2})
    for (const auto treatment :
         {BodyParameters::VolumetricTreatment::standard, BodyParameters::VolumetricTreatment::mean_dilatation})
    {
      Parameters p                     = block();
      p.degree                         = degree;
      p.bodies[0].volumetric_treatment = treatment;
      const Run         run            = follow(p);
      const std::string name           = "degree " + std::to_string(degree) +
                               (treatment == BodyParameters::VolumetricTreatment::standard ? "" : ", mean dilatation");
      check(name + ": force when it is compressed", run.forces[2], closed_form(1.), 1e-8);
      check(name + ": force when it has relaxed", run.forces.back(), closed_form(3.), 1e-8);
      check(name + ": largest deviation of all increments", run.deviation, 0., 1e-8, 1.);
    }

  Parameters adaptive               = block();
  adaptive.adaptivity.interval      = 2;
  adaptive.adaptivity.maximum_level = 1;
  adaptive.adaptivity.indicator     = AdaptivityParameters::Indicator::own;
  adaptive.adaptivity.own_indicator = {std::make_shared<LowerHalf>(), "lower half"};
  const Run refined                 = follow(adaptive);
  check_equal("refined on the way: sites", refined.sites, 5 * 7);
  check("refined on the way: largest deviation", refined.deviation, 0., 1e-8, 1.);

  Parameters p                 = block();
  p.output.checkpoint_interval = 4;
  const Run whole              = follow(p);
  MPI_Barrier(world());
  const Run again = follow(p, first_rank, true);
  MPI_Barrier(world());
  if (root())
  {
    check_equal("restart: increments", again.forces.size(), 3);
    check("restart: largest deviation", again.deviation, 0., 1e-8, 1.);
    check("restart: force as without", again.forces.back(), whole.forces.back(), 1e-12);
  }

  // copies of parameters share the law: another one has another value
  auto slower                         = maxwell();
  slower->tau_                        = 0.7;
  p.bodies[0].material.own_law.object = slower;
  report("restart with another value", refusal(p, true));
  p.bodies[0].material.own_law = {nullptr, "Maxwell"};
  report("no law", refusal(p));
  Parameters soft                        = block();
  soft.bodies[0].material.own_law.object = std::make_shared<Maxwell>();
  report("a law that is not initialised", refusal(soft));
}
