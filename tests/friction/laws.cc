// A block on a held one is pressed down and dragged until it slips everywhere. What friction resists then:
// - Tresca: the shear limit times the area, whatever the pressure; with a factor 1 + x the integral of that;
// - Coulomb with a shear limit that is reached, or is not;
// - orthotropic Coulomb: with half axes mu_1 and mu_2 of the ellipse, slip along s is resisted by
//   N (mu_1^2 s_1, mu_2^2 s_2) / sqrt(mu_1^2 s_1^2 + mu_2^2 s_2^2), slip being normal to the ellipse;
// - a friction factor of the slip rate: mu f(v) N at the rate of the drag.
// All schemes, three nested loops and merged ones, direct and condensed solver.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  using Scheme = ContactPairParameters::Scheme;
  using Solver = LinearSolverParameters::Type;

  /// Upper block [0,1]^3 on the plane z = 0; pressed until t = 1, dragged along x by 0.1 in each unit of time after.
  Parameters block(const ContactPairParameters &friction, const Scheme scheme, const bool loops, const Solver solver)
  {
    Parameters p;
    p.bodies                            = {box("lower", "1,1,1", {-0.5, -0.5, -1}, {2, 1.5, 0}, 1000, 0.),
                                           box("upper", "2,2,2", {0, 0, 0}, {1, 1, 1}, 1000, 0.)};
    p.boundary_conditions               = {hold("ground", region(1, {0, 1, 2, 3, 4, 5}), {0, 1, 2}),
                                           drive("down", region(2, {z_plus}), 2, "-0.01*min(t,1)"),
                                           drive("drag", region(2, {z_plus}), 0, "0.1*max(t-1,0)"),
                                           hold("guide", region(2, {z_plus}), {1})};
    ContactPairParameters contact       = pair(region(2, {z_minus}), region(1, {z_plus}));
    contact.surface_measure             = ContactPairParameters::SurfaceMeasure::reference;
    contact.scheme                      = scheme;
    contact.friction_law                = friction.friction_law;
    contact.friction_coefficient        = friction.friction_coefficient;
    contact.second_friction_coefficient = friction.second_friction_coefficient;
    contact.friction_direction          = friction.friction_direction;
    contact.friction_factor             = friction.friction_factor;
    contact.shear_limit                 = friction.shear_limit;
    p.contact_pairs                     = {contact};
    p.load_stepping.interval_ends       = {1., 3.};
    p.load_stepping.increments          = {1, 5};
    p.linear_solver.type                = solver;
    p.output.results_folder             = "laws_results";
    p.output.write_vtu                  = false;
    if (loops)
      use_loops(p);
    return p;
  }

  ContactPairParameters coulomb(const double mu)
  {
    ContactPairParameters friction;
    friction.friction_coefficient = mu;
    return friction;
  }

  ContactResultants drag(const ContactPairParameters &friction,
                         const Scheme                 scheme,
                         const bool                   loops  = false,
                         const Solver                 solver = Solver::direct)
  {
    ContactProblem problem(block(friction, scheme, loops, solver), world(), log());
    problem.run();
    return problem.contact_resultants()[0];
  }

  void run(const Scheme scheme)
  {
    if (root())
      std::cout << text_of(scheme) << std::endl;
    ContactPairParameters tresca;
    tresca.friction_law = ContactPairParameters::FrictionLaw::tresca;
    tresca.shear_limit  = 0.05;
    check("Tresca", -drag(tresca, scheme).slave_force[0], 0.05, 1e-8);
    check("Tresca, three loops", -drag(tresca, scheme, true).slave_force[0], 0.05, 1e-8);
    tresca.friction_factor = "1+x";
    check("Tresca times 1 + x", -drag(tresca, scheme, false, Solver::condensed).slave_force[0], 1.5 * 0.05, 1e-8);

    ContactPairParameters capped = coulomb(0.3);
    capped.shear_limit           = 0.05;
    check("Coulomb, limit reached", -drag(capped, scheme).slave_force[0], 0.05, 1e-8);
    capped.shear_limit = 50.;
    auto contact       = drag(capped, scheme);
    check("Coulomb, limit not reached", -contact.slave_force[0] / contact.slave_force[2], 0.3, 1e-8);

    ContactPairParameters orthotropic       = coulomb(0.3);
    orthotropic.second_friction_coefficient = 0.1;
    orthotropic.friction_direction          = Vector3({3, 4, 0.2}); // axes (0.6, 0.8) and (-0.8, 0.6)
    const double norm                       = std::hypot(0.3 * 0.6, 0.1 * 0.8);
    for (const bool loops : {false, true})
    {
      contact        = drag(orthotropic, scheme, loops, loops ? Solver::direct : Solver::condensed);
      const double N = contact.slave_force[2];
      check("orthotropic, along",
            -(contact.slave_force[0] * 0.6 + contact.slave_force[1] * 0.8) / N,
            0.3 * 0.3 * 0.6 / norm,
            2e-5);
      check("orthotropic, across",
            -(-contact.slave_force[0] * 0.8 + contact.slave_force[1] * 0.6) / N,
            -0.1 * 0.1 * 0.8 / norm,
            2e-5);
    }

    ContactPairParameters weakening = coulomb(0.3);
    weakening.friction_factor       = "0.6+0.4*exp(-v/0.2)";
    const double mu                 = 0.3 * (0.6 + 0.4 * std::exp(-0.1 / 0.2));
    for (const bool loops : {false, true})
    {
      contact = drag(weakening, scheme, loops);
      check("weakening with the slip rate", -contact.slave_force[0] / contact.slave_force[2], mu, 1e-5);
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Scheme scheme : {Scheme::nodal, Scheme::integration_point, Scheme::averaged})
    run(scheme);

  ContactPairParameters negative = coulomb(0.3);
  negative.friction_factor       = "0.01-v";
  try
  {
    drag(negative, Scheme::nodal);
    check("a negative friction factor is refused", false);
  }
  catch (const InputError &error)
  {
    check("a negative friction factor is refused",
          std::string(error.what()).find("'Friction factor = 0.01-v'") != std::string::npos);
  }
}
