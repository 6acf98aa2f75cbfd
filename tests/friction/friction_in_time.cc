// Friction that depends on the time: a unit cube, pressed with 2 on a rigid floor, slides from the start, without
// friction until t = 1, then with a coefficient that grows to 0.3 until t = 2 and stays. The drag carries mu 2; what is
// dissipated in an increment is that at its end times the slip.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  for (const auto &[mode, name] : {std::make_pair(LoopParameters::Mode::newton, "merged loops"),
                                   {LoopParameters::Mode::fixed_point, "three loops"}})
  {
    Parameters p;
    p.bodies              = {box("floor", "4,2,1", {-0.5, -0.5, -1}, {2.5, 1.5, 0}, 1e6, 0.),
                             box("cube", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1e6, 0.)};
    p.boundary_conditions = {
        hold("floor", region(1, {x_minus, x_plus, y_minus, y_plus, z_minus, z_plus}), {0, 1, 2}),
        hold("guide", region(2, {y_minus, y_plus}, "z > 0.1"), {1}),
        drive("drag", region(2, {x_minus, x_plus}, "z > 0.1"), 0, "0.3*t"),
        condition("weight", BoundaryConditionParameters::Type::traction, region(2, {z_plus}), {2}, {"-2*min(4*t,1)"})};
    p.contact_pairs                         = {ContactPairParameters()};
    p.contact_pairs[0].slave                = region(2, {z_minus});
    p.contact_pairs[0].master               = region(1, {z_plus});
    p.contact_pairs[0].friction_coefficient = 0.3;
    p.contact_pairs[0].friction_factor      = "min(1,max(0,t-1))";
    p.load_stepping                         = {{1., 3.}, {4, 8}};
    p.output.results_folder                 = "friction_in_time_results";
    p.output.write_vtu                      = false;
    for (LoopParameters *loop : {&p.geometry_loop, &p.threshold_loop, &p.status_loop})
      loop->mode = mode;

    report("loops", name);
    ContactProblem problem(p, world(), log());
    problem.on_increment(
        [&](unsigned int, const double t)
        {
          std::ostringstream what;
          what << "t = " << t << ": drag";
          const double friction = 0.6 * std::clamp(t - 1., 0., 1.);
          check(what.str(), problem.reactions()[2].second[0], friction, 1e-6, 0.6);
          check("  friction", problem.contact_resultants()[0].friction[0], -friction, 1e-6, 0.6);
          check("  iterations", problem.iterations().newton <= 12);
        });
    problem.run();
  }
}
