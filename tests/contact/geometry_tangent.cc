// The contact tangent with the variation of the geometry against central differences of the contact residual with
// pairing renewed at every step, nodal forces kept (multipliers follow the areas), frictionless, on bumpy surfaces that
// do not match. With slave nodes on the master it is exact for the nodal scheme on facets, with averaged normals and on
// rigid masters in closed form, with hanging nodes on both surfaces too. On smoothed surfaces and averaged jumps, what
// is left out (geometry_tangent.h) stays small against what is gained.

#include "contact/geometry_tangent.h"

#include "../contact_fixture.h"

#include <random>

using namespace Cases;

namespace
{
  std::vector<double> flat_residual(ContactFixture &fixture)
  {
    const ContactResidual r      = fixture.assemble();
    const auto           &layout = fixture.surfaces->layout();
    std::vector<double>   R(layout.size(), 0.);
    for (unsigned int s = 0; s < fixture.surfaces->n_sites(); ++s)
      for (auto e = fixture.jump.begin(s); e != fixture.jump.end(s); ++e)
        fixture.surfaces->expand(e->node,
                                 e->weight,
                                 [&](const unsigned int node, const double weight)
                                 {
                                   for (unsigned int c = 0; c < 3; ++c)
                                     R[fixture.surfaces->nodes()[node].dofs[c]] += weight * r.jump[s][c];
                                 });
    // gaps, not their integrals: these vary with the areas
    for (unsigned int k = 0; k < layout.n_slave_nodes; ++k)
      R[layout.lambda(k)] = r.lambda[k] / fixture.weights.area()[k];
    return R;
  }

  /// Hanging nodes go to where those that they follow take them.
  void follow(ContactFixture &fixture)
  {
    auto &x = fixture.state.x;
    for (unsigned int i = 0; i < x.size(); ++i)
    {
      const SurfaceNode &node = fixture.surfaces->nodes()[i];
      if (node.masters.empty())
        continue;
      Vector3 at = node.offset;
      for (const auto &[master, weight] : node.masters)
        at += weight * x[master];
      x[i] = Point(at);
    }
  }

  /// Pairing at the state's positions; multipliers keep their nodal forces.
  void pair_again(ContactFixture &fixture, const std::vector<double> &force)
  {
    follow(fixture);
    fixture.pair_at(fixture.state.x);
    for (unsigned int k = 0; k < force.size(); ++k)
      fixture.state.lambda[k] = force[k] / fixture.weights.area()[k];
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Pair  = ContactPairParameters;
  using Shape = MasterSurfaceParameters::Shape;
  struct Kind
  {
    std::string   name;
    Pair::Scheme  scheme;
    Pair::Surface surface;
    Pair::Normal  normal;
    double        tolerance;
    Shape         shape   = Shape::mesh; ///< of a rigid master
    bool          hanging = false;       ///< nodes on both surfaces
  };
  const Kind kinds[] = {
      {"nodal, facets, master normals", Pair::Scheme::nodal, Pair::Surface::faceted, Pair::Normal::master_facet, 1e-5},
      {"nodal, facets, averaged normals", Pair::Scheme::nodal, Pair::Surface::faceted, Pair::Normal::averaged, 1e-5},
      {"nodal, smoothed", Pair::Scheme::nodal, Pair::Surface::smoothed, Pair::Normal::averaged, 0.003},
      {"averaged, facets", Pair::Scheme::averaged, Pair::Surface::faceted, Pair::Normal::averaged, 0.15},
      {"averaged, smoothed", Pair::Scheme::averaged, Pair::Surface::smoothed, Pair::Normal::averaged, 0.15},
      {"nodal, rigid sphere", Pair::Scheme::nodal, Pair::Surface::faceted, Pair::Normal::averaged, 1e-5, Shape::sphere},
      {"nodal, rigid cylinder",
       Pair::Scheme::nodal,
       Pair::Surface::faceted,
       Pair::Normal::averaged,
       1e-5,
       Shape::cylinder},
      {"nodal, rigid paraboloid",
       Pair::Scheme::nodal,
       Pair::Surface::faceted,
       Pair::Normal::averaged,
       1e-5,
       Shape::paraboloid},
      {"averaged, rigid paraboloid",
       Pair::Scheme::averaged,
       Pair::Surface::faceted,
       Pair::Normal::averaged,
       0.15,
       Shape::paraboloid},
      {"nodal, facets, hanging nodes",
       Pair::Scheme::nodal,
       Pair::Surface::faceted,
       Pair::Normal::averaged,
       1e-5,
       Shape::mesh,
       true},
      {"nodal, smoothed, hanging nodes",
       Pair::Scheme::nodal,
       Pair::Surface::smoothed,
       Pair::Normal::averaged,
       0.003,
       Shape::mesh,
       true},
      {"averaged, smoothed, hanging nodes",
       Pair::Scheme::averaged,
       Pair::Surface::smoothed,
       Pair::Normal::averaged,
       0.2, // rougher
       Shape::mesh,
       true}};
  for (const auto &[name, scheme, surface, normal, tolerance, shape, hanging] : kinds)
  {
    auto p    = pair(region(2, {z_minus}), region(1, {z_plus}));
    p.scheme  = scheme;
    p.surface = surface;
    p.normal  = normal;
    if (shape != Shape::mesh)
    {
      const bool apex         = shape == Shape::paraboloid;
      p.master                = RegionParameters();
      p.master_surface.shape  = shape;
      p.master_surface.point  = Point(0.5, 0.4, apex ? 1. : -1.);
      p.master_surface.axis   = apex ? Vector3({0.1, 0.2, 1.}) : Vector3({1., 0.1, 0.});
      p.master_surface.radius = 2.;
    }
    std::vector<BodyParameters> bodies{box("lower", "4,4,1", {-0.1, -0.1, 0}, {1.1, 1.1, 1}, 1, 0),
                                       box("upper", "2,2,1", {0.13, 0.07, 1}, {0.93, 0.87, 2}, 1, 0)};
    if (hanging)
    {
      bodies[0].refine_where = "x+y<1";
      bodies[1].refine_where = "x>0.5";
      for (auto &body : bodies)
        body.local_refinement = 1;
    }
    ContactFixture fixture(bodies, {p}, 1);
    auto          &state = fixture.state;

    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> random(-1., 1.);
    for (auto &x : state.x)
      x += Vector3({0.01 * random(generator), 0.01 * random(generator), 0.1 * x[0] * x[1] + 0.005 * random(generator)});
    for (unsigned int iteration = 0; iteration < 20; ++iteration) // slave nodes onto the master
    {
      follow(fixture);
      fixture.pair_at(state.x);
      for (unsigned int k = 0; k < fixture.surfaces->slave_nodes().size(); ++k)
        state.x[fixture.surfaces->slave_nodes()[k].node] -= fixture.jump.jump(k, state.x);
    }
    std::vector<double> force;
    for (unsigned int k = 0; k < state.lambda.size(); ++k)
    {
      fixture.status->assign(k, true, true, 0.);
      force.push_back(-0.05 * (1. + 0.5 * random(generator)));
    }
    pair_again(fixture, force);

    const auto residual = fixture.assemble();
    const auto frozen   = fixture.matrix();
    GeometryTangent(fixture.pairs,
                    *fixture.surfaces,
                    *fixture.geometry,
                    fixture.averaged,
                    fixture.pairing,
                    fixture.jump,
                    fixture.weights,
                    *fixture.status)
        .add(state, residual, fixture.system);
    auto K = fixture.matrix();

    const auto  &layout   = fixture.surfaces->layout();
    const auto   area     = fixture.weights.area();
    double       error[2] = {0., 0.}, left[2] = {0., 0.}, gained[2] = {0., 0.}; // forces, gaps
    const double step = 1e-6;
    for (unsigned int i = 0; i < state.x.size(); ++i)
      for (unsigned int c = 0; c < 3 && fixture.surfaces->nodes()[i].masters.empty(); ++c)
      {
        const DoFIndex      column = fixture.surfaces->nodes()[i].dofs[c];
        std::vector<double> difference(K.m(), 0.);
        for (const double sign : {1., -1.})
        {
          state.x[i][c] += sign * step;
          pair_again(fixture, force);
          const auto R = flat_residual(fixture);
          for (unsigned int row = 0; row < K.m(); ++row)
            difference[row] += sign * R[row] / (2 * step);
          state.x[i][c] -= sign * step;
        }
        for (unsigned int row = 0; row < layout.Lambda(0, 0); ++row)
        {
          const bool   gap   = row >= layout.lambda(0);
          const double scale = gap ? 1. / area[row - layout.lambda(0)] : 1.;
          error[gap]         = std::max(error[gap], std::abs(scale * K(row, column) - difference[row]));
          left[gap]          = std::max(left[gap], std::abs(scale * frozen(row, column) - difference[row]));
        }
      }
    for (const bool gap : {false, true})
      gained[gap] = error[gap] / left[gap];
    if (std::getenv("NODUS_TEST_LOG") != nullptr)
      std::cout << name << ": forces " << error[0] << " of " << left[0] << ", gaps " << error[1] << " of " << left[1]
                << std::endl;
    check(name + ": variation of forces within " + std::to_string(tolerance), gained[0] <= tolerance);
    check(name + ": variation of gaps within " + std::to_string(tolerance), gained[1] <= tolerance || error[1] < 1e-7);
  }
}
