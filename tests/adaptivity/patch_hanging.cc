// The patch test on meshes refined at random, with hanging nodes on both surfaces: two blocks pressed together by 25,
// lambda = -25 everywhere and the top displacement -0.025 for averaged jumps over segments, to round-off, with every
// solver. Every scheme balances forces and moments between the surfaces.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace Cases;

namespace
{
  Parameters blocks(const unsigned int seed, const unsigned int degree, const bool upper_is_slave)
  {
    Parameters p;
    p.degree = degree;
    p.bodies = {box("lower", "3,3,2", {0, 0, 0}, {1, 1, 1}, 2000., 0.3),
                box("upper", "2,2,2", {0, 0, 1}, {1, 1, 2}, 2000., 0.3)};
    for (auto &body : p.bodies)
    {
      body.local_refinement = degree == 1 ? 2 : 1;
      body.refine_where     = "sin(12989.8*x+78233*y+37719*z+" + std::to_string(seed) + ")>0.4";
    }
    p.boundary_conditions = {hold("x", region(0, {x_minus}), {0}),
                             hold("y", region(0, {y_minus}), {1}),
                             hold("z", region(1, {z_minus}), {2}),
                             press("top", region(2, {z_plus}), "25")};
    const auto lower = region(1, {z_plus}), upper = region(2, {z_minus});
    p.contact_pairs                    = {upper_is_slave ? pair(upper, lower) : pair(lower, upper)};
    p.contact_pairs[0].surface_measure = ContactPairParameters::SurfaceMeasure::reference;
    p.contact_pairs[0].scheme          = ContactPairParameters::Scheme::averaged;
    p.contact_pairs[0].start.status    = ContactPairParameters::InitialStatus::closed;
    p.output.results_folder            = "patch_hanging_results";
    p.output.write_vtu                 = false;
    return p;
  }

  struct Result
  {
    double       deviation = 0.;          ///< of multipliers and top displacement, relative
    double       force = 0., moment = 0.; ///< out of balance, relative to the force
    unsigned int hanging = 0;             ///< nodes of the slave surface
  };

  Result run(const Parameters &p)
  {
    ContactProblem problem(p, world(), log());
    problem.run();
    Result      result;
    const auto &fields = problem.contact_fields()[0];
    for (unsigned int i = 0; i < fields.X.size(); ++i)
    {
      result.deviation = std::max(result.deviation, std::abs(fields.multiplier[i] / -25. - 1.));
      result.hanging += fields.area[i] == 0.;
    }
    for (const double x : {0., 1.})
      for (const double y : {0., 1.})
        result.deviation = std::max(result.deviation, std::abs(problem.displacement(2, {x, y, 2.})[2] / -0.025 - 1.));
    const auto  &resultants = problem.contact_resultants()[0];
    const double scale      = resultants.slave_force.norm();
    result.force            = (resultants.slave_force + resultants.master_force).norm() / scale;
    result.moment           = (resultants.slave_moment + resultants.master_moment).norm() / scale;
    return result;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Scheme               = ContactPairParameters::Scheme;
  using Solver               = LinearSolverParameters::Type;
  const unsigned int n_seeds = 20;

  unsigned int hanging = 0;
  for (const unsigned int degree : {1u, 2u})
  {
    double worst = 0., unbalanced = 0.;
    for (unsigned int seed = 0; seed < (degree == 1 ? n_seeds : 3); ++seed)
    {
      Parameters p             = blocks(seed, degree, seed % 2 == 0);
      p.newton.force_tolerance = 1e-12;
      p.linear_solver.type     = seed % 3 == 0 ? Solver::direct : seed % 3 == 1 ? Solver::condensed : Solver::block;
      const Result result      = run(p);
      worst                    = std::max(worst, result.deviation);
      unbalanced               = std::max({unbalanced, result.force, result.moment});
      hanging += result.hanging;
      if (std::getenv("NODUS_TEST_LOG") != nullptr && root())
        std::cout << "Q" << degree << " seed " << seed << " deviation " << result.deviation << " force " << result.force
                  << " moment " << result.moment << " hanging " << result.hanging << std::endl;
    }
    const std::string name = "Q" + std::to_string(degree) + ", averaged over segments";
    check(name + ", multipliers and displacement", worst, 0., 1e-9, 1.);
    check(name + ", force and moment", unbalanced, 0., 1e-10, 1.);
  }
  check("nodes hang on the slave surfaces", hanging > 100);

  // The force of a node that overhangs the master acts beside it: there the master is larger.
  for (const unsigned int degree : {1u, 2u})
    for (const Scheme scheme : {Scheme::nodal, Scheme::integration_point, Scheme::averaged})
    {
      Parameters p              = blocks(3, degree, true);
      p.contact_pairs[0].scheme = scheme;
      // nodes on the edges of facets need smooth normals; gaps between nodes are along those of the facets
      if (scheme == Scheme::nodal)
      {
        p.contact_pairs[0].normal       = ContactPairParameters::Normal::averaged;
        p.bodies[0].generator_arguments = "3,3,2 : 0,0,0 : 1.3,1.3,1 : true";
      }
      p.contact_pairs[0].integration = ContactPairParameters::Integration::face;
      const Result result            = run(p);
      const char  *names[]           = {"nodal", "integration point", "averaged by faces"};
      check("Q" + std::to_string(degree) + ", " + names[static_cast<unsigned int>(scheme)] + ", force and moment",
            std::max(result.force, result.moment),
            0.,
            1e-10,
            1.);
      if (scheme == Scheme::nodal)
      {
        p.contact_pairs[0].weights = ContactPairParameters::Weights::consistent;
        const Result consistent    = run(p);
        check("Q" + std::to_string(degree) + ", nodal with consistent weights, force and moment",
              std::max(consistent.force, consistent.moment),
              0.,
              1e-10,
              1.);
      }
    }

  // A slave region that ends where the cells become coarser: the node in the middle of the coarse edge belongs to it.
  for (const auto scheme : {Scheme::averaged, Scheme::nodal, Scheme::integration_point})
  {
    Parameters p;
    p.degree                     = 2;
    p.bodies                     = {box("block", "2,1,1", {0, 0, -1}, {2, 1, 0}, 1000., 0.3)};
    p.bodies[0].local_refinement = 1;
    p.bodies[0].refine_where     = "x<1";
    p.boundary_conditions        = {hold("ground", region(1, {z_minus}), {0, 1, 2})};
    p.contact_pairs              = {pair(region(1, {z_plus}, "x<1"), RegionParameters())};
    auto &contact                = p.contact_pairs[0];
    contact.scheme               = scheme;
    auto &plane                  = contact.master_surface;
    plane.shape                  = MasterSurfaceParameters::Shape::plane;
    plane.axis                   = Vector3({0., 0., -1.});
    plane.motion.translation     = {"0", "0", "-0.001*t"};
    contact.start.status         = ContactPairParameters::InitialStatus::closed;
    p.output.results_folder      = "patch_hanging_results";
    p.output.write_vtu           = false;
    ContactProblem problem(p, world(), log());
    problem.run();
    check("rim beside coarser cells: displacement", problem.displacement(1, {1., 0.5, 0.})[2], -0.001, 1e-8);
  }
}
