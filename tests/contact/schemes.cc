// Every scheme with friction at finite strain: a block is pressed on a smaller one that it overhangs, meshes that do
// not match, and dragged. Action and reaction balance, all sites that touch slip, and the friction force is mu times
// the normal one. The forces printed are the same on every number of ranks.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Scheme      = ContactPairParameters::Scheme;
  using Integration = ContactPairParameters::Integration;
  struct Kind
  {
    std::string name;
    Scheme      scheme;
    Integration integration;
  };
  const Kind kinds[] = {{"nodal", Scheme::nodal, Integration::face},
                        {"averaged, face", Scheme::averaged, Integration::face},
                        {"averaged, segment", Scheme::averaged, Integration::segment},
                        {"integration point", Scheme::integration_point, Integration::face}};

  for (const unsigned int degree : {1u, 2u})
    for (const auto &kind : kinds)
    {
      Parameters p;
      // the upper block overhangs at x = 0; integration points would go in and out of contact at the edge
      const double begin = kind.scheme == Scheme::integration_point ? -0.5 : 0.15;
      p.degree           = degree;
      p.bodies           = {box("lower", "3,2,1", {begin, -0.5, 0}, {2.3, 1.5, 0.5}, 1e5, 0.),
                            box("upper", "4,3,1", {0, 0, 0.5}, {2, 1, 1}, 1e3, 0.3)};
      for (auto &body : p.bodies)
        body.material.law = MaterialParameters::Law::neo_hookean;
      p.boundary_conditions           = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                                         drive("down", region(2, {z_plus}), 2, "-0.01*min(t,1)"),
                                         drive("drag", region(2, {z_plus}), 0, "0.03*max(0,t-1)"),
                                         hold("side", region(2, {z_plus}), {1})};
      p.contact_pairs                 = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.2)};
      auto &contact                   = p.contact_pairs[0];
      contact.scheme                  = kind.scheme;
      contact.integration             = kind.integration;
      contact.surface                 = ContactPairParameters::Surface::smoothed;
      contact.normal                  = ContactPairParameters::Normal::averaged;
      p.load_stepping                 = {{1., 2.}, {1, 2}};
      p.output.results_folder         = "schemes_results";
      p.threshold_loop.maximum_passes = 30;

      ContactProblem problem(p, world(), log());
      problem.run();
      const auto  &r    = problem.contact_resultants()[0];
      const double size = r.slave_force.norm();
      if (root())
        std::cout << "Q" << degree << ", " << kind.name << ": forces " << std::setprecision(7) << r.slave_force[0]
                  << ' ' << r.slave_force[2] << ", stick " << r.stick << std::endl;
      check("  action and reaction", (r.slave_force + r.master_force).norm(), 0., 1e-12, size);
      check("  friction over normal force", -r.slave_force[0] / r.slave_force[2], 0.2, 1e-3);
    }
}
