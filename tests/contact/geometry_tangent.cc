// The contact tangent with the variation of the geometry against central differences of the contact residual with
// pairing renewed at every step, on bumpy surfaces that do not match: nodal forces kept (multipliers follow the areas),
// friction multipliers turned with the frames, all as the solver does; also on rigid masters. Frictionless, sticking,
// slipping and tied; slave faces that stick out of the master, and that see a part of it that is steep; bodies that
// have turned by 70 degrees in the increment; one surface that comes near to itself. Exact but for how smoothing shifts
// points along averaged surfaces, and for the areas of the nodal scheme with friction (geometry_tangent.h).

#include "contact/geometry_tangent.h"
#include "contact/site_values.h"

#include "../contact_fixture.h"
#include "../stl.h"

#include <random>

using namespace Cases;

namespace
{
  using Pair   = ContactPairParameters;
  using Shape  = MasterSurfaceParameters::Shape;
  using Normal = Pair::Normal;

  const std::string stl_file = "geometry_tangent.stl";

  enum class Friction
  {
    none,
    stick,
    slip,
    slip_coupled, ///< the threshold follows the pressure
    tied
  };

  struct Kind
  {
    std::string       name;
    Pair::Scheme      scheme;
    Pair::Surface     surface;
    Friction          friction    = Friction::none;
    double            tolerance   = 1e-6;
    Normal            normal      = Normal::averaged;
    Pair::Integration integration = Pair::Integration::segment;
    Shape             shape       = Shape::mesh; ///< of a rigid master
    bool              hanging     = false;       ///< nodes on both surfaces
    double            overhang    = 0.;          ///< of slave faces over the rim of the master [faces]
    double            degrees     = 0.;          ///< that both bodies turn
    unsigned int      degree      = 1;
    bool              orthotropic = false;
    bool              gives_way   = false; ///< a pressure-gap law and elastic slip
    double            bend        = 0.;    ///< of the master, down along x = 0.2, in degrees
    double            apart       = 0.;    ///< distance of surfaces that are one, which is near enough for a part
  };

  /// A fixture whose multipliers keep what the solver keeps when it pairs again.
  class Kept
  {
  public:
    Kept(const Kind &kind, ContactFixture &fixture)
        : kind_(kind)
        , fixture_(fixture)
        , before_(fixture.pairing)
        , Lambda_(fixture.state.Lambda)
    {
      for (unsigned int k = 0; k < fixture.state.lambda.size(); ++k)
      {
        force_.push_back(fixture.state.lambda[k] * fixture.weights.area()[k]);
      }
    }

    void pair_again()
    {
      auto &state = fixture_.state;
      follow(fixture_);
      fixture_.pair_at(state.x);
      for (unsigned int i = 0; i < state.x.size(); ++i)
        state.increment[i] = state.x[i] - fixture_.surfaces->nodes()[i].X;
      for (unsigned int k = 0; k < force_.size(); ++k)
      {
        state.lambda[k] = force_[k] / fixture_.weights.area()[k];
        Vector3 Lambda;
        double  norm = 0.;
        for (unsigned int i = 0; i < 2; ++i)
          Lambda += Lambda_[k][i] * before_[k].tangent[i];
        for (unsigned int i = 0; i < 2; ++i)
        {
          state.Lambda[k][i] = Lambda * fixture_.pairing[k].tangent[i];
          norm += state.Lambda[k][i] * state.Lambda[k][i];
        }
        for (double &component : state.Lambda[k])
          component *= norm > 0. ? Lambda.norm() / std::sqrt(norm) : 0.;
      }
      if (kind_.friction == Friction::slip_coupled)
        fixture_.status->freeze_threshold(
            site_pressure(*fixture_.surfaces, fixture_.weights, *fixture_.status, state.lambda));
    }

    /// Hanging nodes go to where those that they follow take them.
    static void follow(ContactFixture &fixture)
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

    ContactResidual assemble()
    {
      fixture_.surfaces->layout().reinit(fixture_.system.rhs);
      return fixture_.assembler->assemble(fixture_.state, fixture_.system, kind_.friction == Friction::slip_coupled);
    }

    /// What the rows of slave node k are divided by: gaps and slips, not their integrals, which vary with the areas.
    double factor(const unsigned int k, const bool gap) const
    {
      const double area = fixture_.weights.area()[k], threshold = fixture_.status->threshold(k);
      if (gap || !fixture_.status->friction(k))
        return area;
      return area * threshold *
             (fixture_.status->stick(k) ? 1. : 1. / fixture_.status->tangential_augmentation(k, threshold));
    }

    std::vector<double> flat_residual()
    {
      const ContactResidual r      = assemble();
      const auto           &layout = fixture_.surfaces->layout();
      std::vector<double>   R(layout.size(), 0.);
      for (unsigned int s = 0; s < fixture_.surfaces->n_sites(); ++s)
        for (auto e = fixture_.jump.begin(s); e != fixture_.jump.end(s); ++e)
          for (unsigned int c = 0; c < 3; ++c)
            R[fixture_.surfaces->nodes()[e->node].dofs[c]] += fixture_.jump.force(s, *e, r.jump[s])[c];
      for (unsigned int k = 0; k < layout.n_slave_nodes; ++k)
      {
        R[layout.lambda(k)] = r.lambda[k] / factor(k, true);
        for (unsigned int i = 0; i < 2; ++i)
          R[layout.Lambda(k, i)] = r.Lambda[k][i] / factor(k, false);
      }
      return R;
    }

  private:
    const Kind                        &kind_;
    ContactFixture                    &fixture_;
    const Pairing                      before_;
    std::vector<std::array<double, 2>> Lambda_;
    std::vector<double>                force_;
  };

  Vector3 turned(const Vector3 &x, const double degrees)
  {
    const Vector3 axis({1, 2, 0.5}), e = axis / axis.norm();
    const double  a = degrees * dealii::numbers::PI / 180;
    return std::cos(a) * x + std::sin(a) * dealii::cross_product_3d(e, x) + (1 - std::cos(a)) * (e * x) * e;
  }

  Pair make_pair(const Kind &kind)
  {
    auto p        = pair(region(2, {z_minus}), region(1, {z_plus}));
    p.scheme      = kind.scheme;
    p.surface     = kind.surface;
    p.normal      = kind.normal;
    p.integration = kind.integration;
    if (kind.apart > 0.)
    {
      p.slave             = region(1, {});
      p.slave.bodies      = {1, 2};
      p.slave.ids_of_body = {{1, {z_plus}}, {2, {z_minus}}};
      p.master            = p.slave;
      p.self_contact      = true;
      p.search_distance   = 4. / 3. * kind.apart;
    }
    if (kind.friction == Friction::tied)
      p.contact_law = Pair::ContactLaw::tied;
    else if (kind.friction != Friction::none)
      p.friction_coefficient = 0.3;
    if (kind.orthotropic)
    {
      p.second_friction_coefficient = 0.2;
      p.friction_direction          = Vector3({1., 0.5, 0.2});
    }
    if (kind.gives_way)
    {
      p.elastic_slip                   = kind.friction == Friction::none ? 0. : 0.05;
      p.pressure_gap.law               = PressureGapParameters::Law::exponential;
      p.pressure_gap.stiffness         = 20.;
      p.pressure_gap.stiffening_length = 0.03;
    }
    if (kind.shape != Shape::mesh)
    {
      const bool apex         = kind.shape == Shape::paraboloid;
      p.master                = RegionParameters();
      p.master_surface.shape  = kind.shape;
      p.master_surface.point  = Point(0.5, 0.4, apex ? 1. : -1.);
      p.master_surface.axis   = apex ? Vector3({0.1, 0.2, 1.}) : Vector3({1., 0.1, 0.});
      p.master_surface.radius = 2.;
      if (kind.shape == Shape::triangles)
      {
        p.master_surface.file   = stl_file;
        p.master_surface.axis   = Vector3();
        p.master_surface.radius = 0.;
      }
    }
    return p;
  }

  /// A ball with bumps and the radius 2: triangles of 0.6.
  void write_triangles()
  {
    auto triangles = Stl::icosphere(2, 2.);
    for (auto &triangle : triangles)
      for (Point &p : triangle)
        p *= 1. + 0.01 * std::sin(4. * p[0] + 1.) * std::cos(3. * p[1]);
    Stl::write_ascii(stl_file, triangles);
  }

  bool is_slave(const ContactFixture &fixture, const unsigned int node)
  {
    for (const SlaveNode &k : fixture.surfaces->slave_nodes())
      if (k.node == node)
        return true;
    return false;
  }

  /// Bumpy surfaces that touch, and multipliers and statuses at random.
  void disturb(const Kind &kind, ContactFixture &fixture)
  {
    auto                                  &state = fixture.state;
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> random(-1., 1.);
    const double                           size = 0.01 / kind.degree;
    if (kind.bend != 0.)
    {
      const double angle = kind.bend * dealii::numbers::PI / 180.;
      for (unsigned int i = 0; i < state.x.size(); ++i)
        if (const double beyond = 0.2 - state.x[i][0]; beyond > 1e-6 && !is_slave(fixture, i))
          state.x[i] += Vector3({(1. - std::cos(angle)) * beyond, 0., -std::sin(angle) * beyond});
    }
    for (auto &x : state.x)
      x += Vector3(
          {size * random(generator), size * random(generator), 0.1 * x[0] * x[1] + 0.5 * size * random(generator)});
    for (unsigned int iteration = 0; iteration < 20 && kind.bend == 0. && kind.apart == 0.;
         ++iteration) // slave nodes onto the master
    {
      Kept::follow(fixture);
      fixture.pair_at(state.x);
      for (unsigned int k = 0; k < fixture.surfaces->slave_nodes().size(); ++k)
        if (fixture.pairing[k].found)
          state.x[fixture.surfaces->slave_nodes()[k].node] -= fixture.jump.jump(k, state.x);
    }
    if (kind.degrees != 0.)
      for (auto &x : state.x)
        x = Point(turned(x, kind.degrees));
    Kept::follow(fixture);
    fixture.pair_at(state.x);
    for (unsigned int k = 0; k < state.lambda.size(); ++k)
    {
      const bool   stick  = kind.friction == Friction::stick || kind.friction == Friction::tied;
      const double f      = kind.friction == Friction::none ? 0. : -0.3 * (1. + 0.3 * random(generator));
      const bool   closed = fixture.pairing[k].found;
      fixture.status->assign(k, closed, stick, f);
      state.lambda[k] = closed ? -(1. + 0.5 * random(generator)) : 0.;
      for (double &component : state.Lambda[k])
        component = kind.friction == Friction::none || !closed ? 0. : 0.5 * random(generator);
      if (kind.gives_way && kind.friction != Friction::none)
        state.elastic_slip[k] = 0.03 * Vector3({random(generator), random(generator), random(generator)});
    }
  }

  void measure(const Kind &kind)
  {
    const double                upper = kind.overhang > 0. ? 0.3 + 0.4 * kind.overhang : 0.13;
    std::vector<BodyParameters> bodies{
        box("lower", "4,4,1", {-0.1, -0.1, 0}, {1.1, 1.1, 1}, 1, 0),
        box("upper", "2,2,1", {upper, 0.07, 1 + kind.apart}, {upper + 0.8, 0.87, 2}, 1, 0)};
    if (kind.hanging)
    {
      bodies[0].refine_where = "x+y<1";
      bodies[1].refine_where = "x>0.5";
      for (auto &body : bodies)
        body.local_refinement = 1;
    }
    ContactFixture fixture(bodies, {make_pair(kind)}, kind.degree);
    disturb(kind, fixture);
    Kept kept(kind, fixture);
    kept.pair_again();

    auto      &state    = fixture.state;
    const auto residual = kept.assemble();
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
    const auto K = fixture.matrix();

    const auto         &layout = fixture.surfaces->layout();
    std::vector<double> scale(K.m(), 1.);
    for (unsigned int k = 0; k < layout.n_slave_nodes; ++k)
    {
      scale[layout.lambda(k)] = 1. / kept.factor(k, true);
      for (unsigned int i = 0; i < 2; ++i)
        scale[layout.Lambda(k, i)] = 1. / kept.factor(k, false);
    }
    double       error[3] = {0., 0., 0.}, left[3] = {0., 0., 0.}; // forces, gaps, slips
    const double step = 2e-6;
    for (unsigned int i = 0; i < state.x.size(); ++i)
      for (unsigned int c = 0; c < 3 && fixture.surfaces->nodes()[i].masters.empty(); ++c)
      {
        const DoFIndex      column = fixture.surfaces->nodes()[i].dofs[c];
        const Point         x      = state.x[i];
        std::vector<double> difference(K.m(), 0.);
        for (const double sign : {1., -1.})
        {
          state.x[i][c] = x[c] + sign * step;
          kept.pair_again();
          const auto R = kept.flat_residual();
          for (unsigned int row = 0; row < K.m(); ++row)
            difference[row] += sign * R[row] / (2 * step);
        }
        state.x[i] = x;
        for (unsigned int row = 0; row < K.m(); ++row)
        {
          const unsigned int what = row < layout.lambda(0) ? 0 : row < layout.Lambda(0, 0) ? 1 : 2;
          error[what]             = std::max(error[what], std::abs(scale[row] * K(row, column) - difference[row]));
          left[what]              = std::max(left[what], std::abs(scale[row] * frozen(row, column) - difference[row]));
        }
      }
    const char *const names[3] = {"forces", "gaps", "slips"};
    for (unsigned int what = 0; what < (kind.friction == Friction::none ? 2 : 3); ++what)
    {
      if (std::getenv("NODUS_TEST_LOG") != nullptr)
        std::cout << kind.name << ": " << names[what] << " " << error[what] << " of " << left[what] << " = "
                  << error[what] / left[what] << std::endl;
      // relative to what the tangent of the pairing that is kept lacks, which is the first number
      const double relative = error[what] < 1e-8 ? 0. : error[what] / left[what];
      const bool   tight    = kind.tolerance <= Numbers::tight;
      report(kind.name + ": variation of " + names[what] + ' ' +
                 Numbers::number(left[what] < 1e-8 ? 0. : left[what], 3) +
                 (tight ? " within " + Numbers::plain(kind.tolerance) : ", error"),
             Numbers::error_below(relative, kind.tolerance, 2));
    }
  }

  std::vector<Kind> kinds()
  {
    constexpr auto nodal = Pair::Scheme::nodal, averaged = Pair::Scheme::averaged;
    constexpr auto faceted = Pair::Surface::faceted, smoothed = Pair::Surface::smoothed;
    Kind           nodal_facets{"nodal, facets", nodal, faceted}, plain{"averaged, facets", averaged, faceted},
        smooth{"averaged, smoothed", averaged, smoothed, Friction::none, 3e-3};
    std::vector<Kind> result;
    const auto        add = [&](Kind kind, const std::string &name, const auto &change)
    {
      change(kind);
      kind.name += name;
      result.push_back(kind);
    };
    add(nodal_facets, ", master normals", [](Kind &k) { k.normal = Normal::master_facet; });
    add(nodal_facets, ", averaged normals", [](Kind &) {});
    add({"nodal, smoothed", nodal, smoothed}, "", [](Kind &) {});
    for (const auto &[shape, name] :
         {std::make_pair(Shape::sphere, "sphere"), {Shape::cylinder, "cylinder"}, {Shape::paraboloid, "paraboloid"}})
      add({std::string("nodal, rigid ") + name, nodal, faceted}, "", [shape = shape](Kind &k) { k.shape = shape; });
    for (const auto surface : {faceted, smoothed})
      add({"nodal, rigid triangles, " + text_of(surface), nodal, surface},
          "",
          [](Kind &k) { k.shape = Shape::triangles; });
    add(nodal_facets, ", hanging nodes", [](Kind &k) { k.hanging = true; });
    add({"nodal, smoothed", nodal, smoothed}, ", hanging nodes", [](Kind &k) { k.hanging = true; });
    add(nodal_facets,
        ", slip",
        [](Kind &k)
        {
          k.friction  = Friction::slip;
          k.tolerance = 0.1; // areas are left out
        });

    for (const Kind &base : {plain, smooth})
    {
      for (const auto &[friction, name] : {std::make_pair(Friction::none, ""),
                                           {Friction::stick, ", stick"},
                                           {Friction::slip, ", slip"},
                                           {Friction::slip_coupled, ", slip with the pressure"},
                                           {Friction::tied, ", tied"}})
      {
        add(base, name, [friction = friction](Kind &k) { k.friction = friction; });
        if (friction != Friction::none)
          add(base,
              std::string(name) + ", turned",
              [friction = friction](Kind &k)
              {
                k.friction = friction;
                k.degrees  = 70.;
              });
      }
      add(base, ", by face", [](Kind &k) { k.integration = Pair::Integration::face; });
      add(base,
          ", by face, tied, turned",
          [](Kind &k)
          {
            k.integration = Pair::Integration::face;
            k.friction    = Friction::tied;
            k.degrees     = 70.;
          });
      add(base,
          ", hanging nodes, stick",
          [](Kind &k)
          {
            k.hanging  = true;
            k.friction = Friction::stick;
          });
      for (const double overhang : {0.0125, 0.125, 0.3, 0.6}) // dual functions, these with hats, hats, shared out
        add(base,
            ", overhang " + std::to_string(overhang) + ", stick",
            [overhang](Kind &k)
            {
              k.overhang = overhang;
              k.friction = Friction::stick;
            });
      // a node over the rim takes the mean of what its points have
      for (const auto &[normal, name] : {std::make_pair(Normal::master_facet, "master"), {Normal::slave, "slave"}})
        add(base,
            std::string(", overhang, ") + name + " normals, slip with the pressure",
            [normal = normal](Kind &k)
            {
              k.normal   = normal;
              k.overhang = 0.3;
              k.friction = Friction::slip_coupled;
            });
      add(base, ", one surface", [](Kind &k) { k.apart = 0.3; });
      // a row of points that fades out (eq. J7)
      add(base,
          ", by face, overhang, stick",
          [](Kind &k)
          {
            k.integration = Pair::Integration::face;
            k.overhang    = 0.04;
            k.friction    = Friction::stick;
            k.tolerance   = 1e-2; // normal and size of the faces at the rim are taken as they are
          });
      add(base,
          ", slave normals, stick",
          [](Kind &k)
          {
            k.normal   = Normal::slave;
            k.friction = Friction::stick;
          });
      add(base, ", master normals", [](Kind &k) { k.normal = Normal::master_facet; });
      add(base,
          ", orthotropic slip",
          [](Kind &k)
          {
            k.orthotropic = true;
            k.friction    = Friction::slip;
          });
    }
    for (const auto &[friction, name] : {std::make_pair(Friction::none, ""),
                                         {Friction::stick, ", stick, turned"},
                                         {Friction::slip, ", slip, turned"},
                                         {Friction::slip_coupled, ", slip with the pressure"}})
      add(plain,
          std::string(", gives way") + name,
          [friction = friction](Kind &k)
          {
            k.gives_way = true;
            k.friction  = friction;
            k.degrees   = friction == Friction::stick || friction == Friction::slip ? 70. : 0.;
          });
    add(plain,
        ", degree 2, stick",
        [](Kind &k)
        {
          k.degree   = 2;
          k.friction = Friction::stick;
        });
    // faces that fade out of normals (eq. P1) and averages (eq. J8)
    for (const Kind &base : {Kind{"nodal, smoothed", nodal, smoothed}, plain})
      for (const double bend : {52., 68.})
        add(base,
            ", bent by " + std::to_string(static_cast<int>(bend)) + " degrees",
            [bend](Kind &k)
            {
              k.bend     = bend;
              k.friction = k.scheme == Pair::Scheme::averaged ? Friction::stick : Friction::none;
            });
    add({"averaged, rigid paraboloid", averaged, faceted},
        ", stick",
        [](Kind &k)
        {
          k.shape    = Shape::paraboloid;
          k.friction = Friction::stick;
        });
    for (const auto &[friction, name] :
         {std::make_pair(Friction::none, ""), {Friction::stick, ", stick"}, {Friction::slip, ", slip"}})
      add({"averaged, rigid triangles", averaged, faceted},
          name,
          [friction = friction](Kind &k)
          {
            k.shape    = Shape::triangles;
            k.surface  = Pair::Surface::smoothed;
            k.degree   = 2; // only the triangles are smoothed
            k.friction = friction;
          });
    return result;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const char *const                        only = std::getenv("NODUS_TEST_KIND");
  write_triangles();
  for (const Kind &kind : kinds())
    if (only == nullptr || kind.name.find(only) != std::string::npos)
      measure(kind);
}
