// An indicator of refinement of the program's own: what it is told about the cells, that the cells it asks for are
// refined, alike on any number of ranks, and that it is refused where it gives no error.

#include "../cases.h"
#include <nodus/plugins/error_indicator.h>

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  /// Cells at the contact are to be at level 2, others by their plastic strain.
  class Touched : public ErrorIndicator
  {
  public:
    double error(const Cell &cell) const override
    {
      double strain = 0., volume = 0.;
      for (const QuadraturePoint &point : cell.points)
      {
        const auto   s       = point.cauchy_stress;
        const double J       = determinant(point.deformation_gradient);
        const double mises   = std::sqrt(1.5) * deviator(s).norm() * J;
        const double allowed = yield_stress + hardening * point.equivalent_plastic_strain;
        beyond_yield         = std::max(beyond_yield, mises / allowed - 1.);
        strain               = std::max(strain, point.equivalent_plastic_strain);
        volume += point.volume;
      }
      total_volume += volume;
      size_off = std::max(size_off, std::abs(std::pow(cell.size, 3) / volume - 1.));
      if (cell.contact_pressure > 0.)
      {
        highest                     = std::max(highest, cell.contact_pressure);
        lowest_level[cell.body - 1] = std::min(lowest_level[cell.body - 1], cell.level);
        ++n_touched;
      }
      return scale * strain * cell.size;
    }
    bool refine(const Cell &cell) const override
    {
      return cell.contact_pressure > 0.;
    }

    void begin() const
    {
      total_volume = highest = 0.;
      n_touched              = 0;
      lowest_level[0] = lowest_level[1] = 9;
    }

    static constexpr double yield_stress = 3., hardening = 50.;
    double                  scale        = 1.;
    mutable double          beyond_yield = 0., size_off = 0., total_volume = 0., highest = 0.;
    mutable unsigned int    n_touched = 0, lowest_level[2] = {9, 9};
  };

  /// A block is pressed on a narrower one that yields.
  Parameters blocks(const std::shared_ptr<ErrorIndicator> &indicator)
  {
    Parameters p;
    p.bodies                            = {box("upper", "4,4,2", {0, 0, 0}, {2, 2, 1}, 1000., 0.3),
                                           box("lower", "2,2,2", {0.5, 0.5, -1}, {1.5, 1.5, 0}, 500., 0.3)};
    auto &metal                         = p.bodies[1].material;
    metal.law                           = MaterialParameters::Law::j2_plasticity;
    metal.yield_stress                  = Touched::yield_stress;
    metal.hardening_modulus             = Touched::hardening;
    p.boundary_conditions               = {hold("ground", region(2, {z_minus}), {0, 1, 2}),
                                           hold("guide", region(1, {z_plus}), {0, 1}),
                                           drive("press", region(1, {z_plus}), 2, "-0.03*t")};
    p.contact_pairs                     = {pair(region(1, {z_minus}), region(2, {z_plus}), 0.)};
    p.contact_pairs[0].start.status     = ContactPairParameters::InitialStatus::closed;
    p.load_stepping.increments          = {3};
    p.adaptivity.interval               = 1;
    p.adaptivity.maximum_level          = 2;
    p.adaptivity.refine_fraction        = 0.4;
    p.adaptivity.coarsen_fraction       = 0.;
    p.adaptivity.slave_at_least_as_fine = false;
    p.adaptivity.indicator              = AdaptivityParameters::Indicator::own;
    p.adaptivity.own_indicator          = {indicator, "touched"};
    p.output.results_folder             = "indicator_results";
    p.output.write_vtu                  = false;
    p.output.checkpoint_interval        = 0;
    return p;
  }

  double sum(const double value)
  {
    return dealii::Utilities::MPI::sum(value, world());
  }
  double largest(const double value)
  {
    return dealii::Utilities::MPI::max(value, world());
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const auto     indicator = std::make_shared<Touched>();
  ContactProblem problem(blocks(indicator), world(), log());
  problem.on_increment(
      [&](const unsigned int increment, const double)
      {
        if (increment > 1)
        {
          const std::string name  = "before increment " + std::to_string(increment);
          const auto        level = [&](const unsigned int body)
          { return -static_cast<int>(largest(-static_cast<double>(indicator->lowest_level[body]))); };
          check(name + ": volume of the cells", sum(indicator->total_volume), 5., 1e-12);
          report(name + ": cells at the contact", Numbers::plain(sum(indicator->n_touched)));
          check_equal(name + ": coarsest of them, upper body", level(0), increment - 2);
          check_equal(name + ": coarsest of them, lower body", level(1), increment - 2);
        }
        indicator->begin();
      });
  problem.run();
  check("size of a cell is the cubic root of its volume", largest(indicator->size_off), 0., 1e-12, 1.);
  check("von Mises stress beyond what its plastic strain allows", largest(indicator->beyond_yield), 0., 1e-9, 1.);

  const auto wrong = std::make_shared<Touched>();
  wrong->scale     = -1.;
  try
  {
    ContactProblem(blocks(wrong), world(), log()).run();
    report("a negative error", "accepted: NO");
  }
  catch (const InputError &error)
  {
    const std::string text = error.what();
    report("a negative error", text.substr(0, text.find(" is ")) + " ... " + text.substr(text.rfind(", and")));
  }
}
