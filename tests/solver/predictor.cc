// Increments that start where the motion of the last one leads (eq. L4). A bar of a linear law that is pulled in time
// is there at once, and takes the one iteration that it takes without. A plastic block with a rigid roll pressed into
// it and rolled, friction 0.2, comes to the same force in fewer iterations; so does one whose load turns back in
// mid-interval, where the motion is no guide. A body on springs that flies at a thin plate comes to rest on it: the
// motion of the increment before would lead through.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <numeric>

using namespace Cases;
using Type = BoundaryConditionParameters::Type;

namespace
{
  struct Outcome
  {
    std::vector<unsigned int> iterations; ///< of the increments
    unsigned int              fallbacks = 0;
    Vector3                   force; ///< on the slave side of the first pair
    double                    tip = 0.;

    unsigned int total() const
    {
      return std::accumulate(iterations.begin(), iterations.end(), 0u);
    }
  };

  Outcome run(Parameters p, const bool predictor, const Point &tip)
  {
    p.load_stepping.predictor = predictor;
    p.output.results_folder   = "predictor_results";
    p.output.vtu_interval     = 0;
    ContactProblem problem(p, world(), log());
    Outcome        outcome;
    problem.on_increment(
        [&](unsigned int, double)
        {
          outcome.iterations.push_back(problem.iterations().newton);
          outcome.fallbacks += problem.iterations().fallbacks;
        });
    problem.run();
    if (!p.contact_pairs.empty())
      outcome.force = problem.contact_resultants()[0].slave_force;
    outcome.tip = problem.displacement(1, tip)[2];
    return outcome;
  }

  Parameters bar()
  {
    Parameters p;
    p.bodies                      = {box("bar", "2,2,4", {0, 0, 0}, {1, 1, 2}, 100, 0.3)};
    p.boundary_conditions         = {hold("end", region(1, {z_minus}), {0, 1, 2}),
                                     drive("pulled", region(1, {z_plus}), 2, "0.01*t"),
                                     condition("sheared", Type::traction, region(1, {z_plus}), {0}, {"0.1*t"})};
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {4};
    return p;
  }

  /// @p down, @p along: of the roll.
  Parameters rolled(const std::string &down, const std::string &along)
  {
    Parameters p;
    p.bodies                               = {box("block", "10,2,4", {-1, 0, -0.8}, {1, 0.4, 0}, 1000, 0.3)};
    p.bodies[0].volumetric_treatment       = BodyParameters::VolumetricTreatment::mean_dilatation;
    p.bodies[0].material.law               = MaterialParameters::Law::j2_plasticity;
    p.bodies[0].material.yield_stress      = 3;
    p.bodies[0].material.hardening_modulus = 20;
    p.boundary_conditions = {hold("bottom", region(1, {z_minus}), {0, 1, 2}), hold("sides", region(1, {2, 3}), {1})};
    ContactPairParameters contact             = pair(region(1, {z_plus}), {}, 0.2);
    contact.scheme                            = ContactPairParameters::Scheme::averaged;
    contact.master_surface.shape              = MasterSurfaceParameters::Shape::cylinder;
    contact.master_surface.point              = Point(-0.3, 0, 1);
    contact.master_surface.axis               = Vector3({0, 1, 0});
    contact.master_surface.radius             = 1.;
    contact.master_surface.motion.translation = {along, "0", down};
    p.contact_pairs                           = {contact};
    p.load_stepping.interval_ends             = {1.};
    p.load_stepping.increments                = {16};
    return p;
  }

  /// Load 1.2 t, springs of 1, gap 0.5: touches at t = 0.42, motions of 0.15 before, a plate of 0.1.
  Parameters flying()
  {
    Parameters p;
    p.bodies                      = {box("flier", "2,2,2", {0, 0, 0.6}, {0.4, 0.4, 1}, 1000, 0.3),
                                     box("plate", "4,4,1", {-0.2, -0.2, 0}, {0.6, 0.6, 0.1}, 1000, 0.3)};
    p.boundary_conditions         = {hold("guide", region(1, {0}), {0, 1}),
                                     hold("support", region(2, {z_minus}), {0, 1, 2}),
                                     condition("springs", Type::spring, region(1, {z_plus}), {2}, {"1"}),
                                     condition("load", Type::traction, region(1, {z_plus}), {2}, {"-1.2*t"})};
    p.contact_pairs               = {pair(region(1, {z_minus}), region(2, {z_plus}))};
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {4};
    return p;
  }

  void compare(const std::string &name, const Parameters &p, const Point &tip, const double part)
  {
    const Outcome with = run(p, true, tip), without = run(p, false, tip);
    check(name + ": the same force without", (with.force - without.force).norm() < 1e-7 * without.force.norm());
    check(name + ": at most " + Numbers::plain(part) + " of the iterations without",
          with.total() <= part * without.total());
    check_equal(name + ": fallbacks", with.fallbacks, 0);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const bool predictor : {true, false})
  {
    const Outcome      outcome = run(bar(), predictor, Point(0, 0, 2));
    std::ostringstream counts;
    for (const unsigned int n : outcome.iterations)
      counts << n << ' ';
    report(predictor ? "bar, iterations of the increments" : "... without", counts.str());
    check("  end of the bar", outcome.tip, 0.01, 1e-12);
  }
  compare("rolled", rolled("-0.03*t", "0.05*t"), Point(1, 0, 0), 0.85);
  compare("there and back", rolled("-0.03*if(t<0.53,t,0.583-0.1*t)", "0"), Point(1, 0, 0), 1.);

  const Outcome flight = run(flying(), true, Point(0, 0, 1));
  check("flying at a plate: force", flight.force[2], 0.16 * (1.2 - 0.5), 0.01); // springs 0.5 long
}
