// Adaptivity of surfaces that touch themselves: a patch of uniform pressure stays exact when half of the cells of one
// body are split, be it slave or master, and what sticks has the friction of the same mesh from the start. Who is slave
// stays: where the master became slave because it is finer now, the friction of what stuck was 3.4 % off.

#include "../cases.h"
#include <nodus/plugins/error_indicator.h>

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  /// Asks for the cells of one half of one body.
  class OneBody : public ErrorIndicator
  {
  public:
    explicit OneBody(const unsigned int body)
        : body_(body)
    {
    }
    double error(const Cell &cell) const override
    {
      return refine(cell) ? 1. : 0.;
    }
    bool refine(const Cell &cell) const override
    {
      return cell.body == body_ && cell.centre[0] < 0.5;
    }

  private:
    unsigned int body_;
  };

  Parameters stack(const double friction, const std::string &shear)
  {
    Parameters p;
    p.bodies              = {box("lower", "3,3,1", {0, 0, 0}, {1, 1, 0.5}, 100., 0.),
                             box("sheet", "4,4,1", {0, 0, 0.5}, {1, 1, 0.6}, 100., 0.),
                             box("upper", "3,4,1", {0, 0, 0.6}, {1, 1, 1.1}, 100., 0.)};
    p.boundary_conditions = {hold("ground", region(1, {z_minus}), {0, 1, 2}),
                             drive("press", region(3, {z_plus}), 2, "-0.011*min(t,1)"),
                             drive("shear", region(3, {z_plus}), 0, shear),
                             hold("guide", region(3, {z_plus}), {1})};
    if (friction == 0.)
      p.boundary_conditions.push_back(hold("sheet", region(2, {x_minus}), {0, 1}));
    else // until there is friction
      p.boundary_conditions.push_back(condition(
          "sheet", BoundaryConditionParameters::Type::spring, region(2, {x_minus}), {0, 1}, {"1e-3", "1e-3"}));
    ContactPairParameters pair;
    pair.name                 = "self";
    pair.slave.bodies         = {1, 2, 3};
    pair.slave.boundary_ids   = {z_minus, z_plus};
    pair.master               = pair.slave;
    pair.self_contact         = true;
    pair.friction_coefficient = friction;
    pair.start.status         = ContactPairParameters::InitialStatus::closed;
    p.contact_pairs           = {pair};
    p.load_stepping           = {{1., 2.}, {1, 1}};
    p.newton.force_tolerance = p.newton.contact_tolerance = 1e-9;
    p.output.results_folder                               = "adaptive_self_contact_results";
    p.output.write_vtu                                    = false;
    p.output.checkpoint_interval                          = 0;
    return p;
  }

  void split_one_body(const unsigned int body, Parameters &p)
  {
    p.adaptivity.interval               = 1;
    p.adaptivity.maximum_level          = 1;
    p.adaptivity.refine_fraction        = 0.5;
    p.adaptivity.coarsen_fraction       = 0.;
    p.adaptivity.slave_at_least_as_fine = false;
    p.adaptivity.indicator              = AdaptivityParameters::Indicator::own;
    p.adaptivity.own_indicator          = {std::make_shared<OneBody>(body), "one body"};
  }

  struct Run
  {
    std::vector<double> friction; ///< of both interfaces, which have opposite signs where one body is slave in both
    std::vector<unsigned int> nodes;
    double                    off = 0., area_off = 0.; ///< the largest of all increments
  };

  Run run(const Parameters &p)
  {
    Run            result;
    ContactProblem problem(p, world(), log());
    problem.on_increment(
        [&](const unsigned int, const double)
        {
          const ContactFields &fields = problem.contact_fields()[0];
          const auto          &sums   = problem.contact_resultants()[0];
          double               off = 0., friction = 0.;
          for (unsigned int k = 0; k < fields.X.size(); ++k)
            if (fields.status[k] != ContactStatus::open && fields.area[k] > 0.)
            {
              off = std::max(off, std::abs(fields.pressure[k] - 1.));
              friction += std::abs(fields.friction[k][0]) * fields.area[k];
            }
          result.off      = std::max(result.off, dealii::Utilities::MPI::max(off, world()));
          result.area_off = std::max(result.area_off, std::abs(sums.contact_area - 2.));
          result.friction.push_back(friction);
          result.nodes.push_back(sums.open + sums.slip + sums.stick);
        });
    problem.run();
    return result;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (unsigned int body = 1; body <= 3; ++body)
  {
    Parameters p = stack(0., "0");
    report(p.bodies[body - 1].name + " is split", "");
    split_one_body(body, p);
    const Run patch = run(p);
    check("  the mesh is finer", patch.nodes.back() > patch.nodes.front());
    check("  pressure off by at most", patch.off, 0., 1e-8, 1.);
    check("  area off by at most", patch.area_off, 0., 1e-8, 1.);
  }

  // the sheet is slave on both sides before and after
  Parameters p = stack(100., "0.002*min(t,1)"), from_the_start = p;
  from_the_start.bodies[1].local_refinement = 1;
  from_the_start.bodies[1].refine_where     = "x<0.5";
  split_one_body(2, p);
  const Run mid_path = run(p), start = run(from_the_start);
  check("sticking: friction as on the same mesh from the start", mid_path.friction.back(), start.friction.back(), 1e-6);
  check_equal("sticking: nodes", mid_path.nodes.back(), start.nodes.back());

  // half of the lower body becomes finer than the sheet, and stays master; on the same mesh from the start it is slave
  Parameters lower = stack(100., "0.002*min(t,1)"), lower_from_the_start = lower;
  lower_from_the_start.bodies[0].local_refinement = 1;
  lower_from_the_start.bodies[0].refine_where     = "x<0.5";
  split_one_body(1, lower);
  const double finer_master = run(lower).friction.back(), finer_slave = run(lower_from_the_start).friction.back();
  check("sticking on a master that becomes the finer one: friction", finer_master, finer_slave, 0.01);
  return 0;
}
