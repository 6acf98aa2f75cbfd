// States that are not what they should be are refused. A block is pressed onto another one and dragged; the state that
// the loops find at the end of the third increment is changed in one place each time, and judged. Printed are the
// measures that it violates; the state as it was holds.

#include "sliding_block.h"

#include "run/increment_loops.h"
#include "run/judge.h"
#include "run/strategy.h"

#include <deal.II/base/mpi.h>

#include <functional>
#include <limits>

using namespace SlidingBlock;

namespace
{
  struct Run
  {
    explicit Run(const Parameters &parameters)
        : p(parameters)
        , journal(p, world(), log())
        , model(p, world(), states)
        , equilibrium(model, journal, states)
        , path(p.load_stepping)
        , loops(model, journal, states, equilibrium, [] {})
        , strategy(model, journal, states, equilibrium, loops)
        , judge(model, states, equilibrium)
    {
      journal.tables = std::make_unique<Tables>(p.output.results_folder, world(), std::vector<std::string>());
      equilibrium.begin_on_mesh();
      model.begin_contact(states, 0.);
    }
    void solve()
    {
      equilibrium.begin_increment(path.at_hand());
      strategy.solve_increment();
    }
    void commit()
    {
      states.now.history = model.solid->reached();
      model.solid->start_from(states.now.history);
      model.contact->end_increment(equilibrium.increment().duration());
      model.rigid_bodies.end_increment(equilibrium.driven().applied());
      states.committed = states.now;
      path.accept(1, true);
    }

    Parameters     p;
    States         states;
    Journal        journal;
    Model          model;
    Equilibrium    equilibrium;
    LoadStepping   path;
    IncrementLoops loops;
    Strategy       strategy;
    Judge          judge;
  };

  /// The slave node that is nearest to a place, on the rank that owns it; an invalid number elsewhere.
  unsigned int slave_near(const Run &run, const Point &X)
  {
    const ContactSurfaces &surfaces = run.model.contact->surfaces();
    std::pair<double, int> nearest(1e9, dealii::Utilities::MPI::this_mpi_process(world()));
    unsigned int           slave = dealii::numbers::invalid_unsigned_int;
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
      if (const double d = surfaces.site_position(k).distance(X); d < nearest.first)
      {
        nearest.first = d;
        slave         = k;
      }
    const auto all = dealii::Utilities::MPI::min_max_avg(nearest.first, world());
    return all.min_index == dealii::Utilities::MPI::this_mpi_process(world()) ? slave
                                                                              : dealii::numbers::invalid_unsigned_int;
  }

  void show(const std::string &what, const Verdict &verdict)
  {
    if (!root())
      return;
    std::cout << what << ":";
    for (unsigned int m = 0; m < n_measures; ++m)
      if (!verdict[static_cast<Measure>(m)].holds())
        std::cout << ' ' << measure_names[m] << ',';
    std::cout << (verdict.holds() ? " holds" : " violated") << std::endl;
    for (unsigned int m = 0; m < n_measures && std::getenv("NODUS_TEST_LOG") != nullptr; ++m)
      if (!verdict[static_cast<Measure>(m)].holds())
        std::cout << "    " << verdict.text(static_cast<Measure>(m)) << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const auto scheme : {ContactPairParameters::Scheme::averaged,
                            ContactPairParameters::Scheme::nodal,
                            ContactPairParameters::Scheme::integration_point})
  {
    Parameters p              = parameters("judge_results");
    p.contact_pairs[0].scheme = scheme;
    p.output.write_vtu        = false;
    Run run(p);
    for (unsigned int increment = 0; increment < 2; ++increment)
    {
      run.solve();
      run.commit();
    }
    run.solve();
    report("scheme", text_of(scheme));
    show("as it was found", run.judge.judge());

    const State            found    = run.states.now;
    State                 &now      = run.states.now;
    const ContactSurfaces &surfaces = run.model.contact->surfaces();
    const unsigned int     k = slave_near(run, {0.8, 0.5, 0.5}), corner = slave_near(run, {0.3, 0.1, 0.5});
    const bool             here = k != dealii::numbers::invalid_unsigned_int;
    const double           nan  = std::numeric_limits<double>::quiet_NaN();
    const auto             site = [&] // a site with a status at the node
    {
      for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
        if (surfaces.is_owned(s) && surfaces.has_status(s) && now.contact.statuses.contact[s])
          return s;
      return dealii::numbers::invalid_unsigned_int;
    };
    const auto tamper = [&](const std::string &what, const std::function<void()> &change)
    {
      change();
      for (unsigned int b = 0; b < 3; ++b)
        now.unknowns.block(b).compress(dealii::VectorOperation::insert);
      show(what, run.judge.judge());
      now = found;
    };
    const auto displace = [&](const unsigned int slave, const unsigned int c, const double by)
    {
      if (slave == dealii::numbers::invalid_unsigned_int)
        return;
      const DoFIndex dof         = surfaces.nodes()[surfaces.slave_nodes()[slave].node].dofs[c];
      const double   u           = now.unknowns.block(0)(dof);
      now.unknowns.block(0)(dof) = u + by;
    };
    const auto displace_body = [&](const unsigned int body, const unsigned int c, const double by)
    {
      const OwnedNodes nodes(run.model.dof_handler, *run.model.mapping);
      const auto       owned = run.model.dof_handler.locally_owned_dofs();
      for (unsigned int i = 0; i < nodes.X.size(); ++i)
        if (nodes.body[i] == body)
        {
          const DoFIndex dof         = owned.nth_index_in_set(3 * i + c);
          const double   u           = now.unknowns.block(0)(dof);
          now.unknowns.block(0)(dof) = u + by;
        }
    };
    const auto scale_multipliers = [&](const unsigned int block, const double factor)
    { now.unknowns.block(block) *= factor; };

    tamper("a displacement that is no number",
           [&]
           {
             if (here)
               now.unknowns.block(0)(surfaces.nodes()[surfaces.slave_nodes()[k].node].dofs[0]) = nan;
           });
    tamper("a multiplier that is infinite",
           [&]
           {
             if (here)
               now.unknowns.block(1)(surfaces.multiplier(k)) = 1. / 0.;
           });
    tamper("a threshold that is no number",
           [&]
           {
             if (const unsigned int s = site(); s < surfaces.n_sites())
               now.contact.statuses.threshold[s] = nan;
           });
    tamper("an energy that is no number", [&] { now.energies.stored = nan; });
    tamper("a node of the interface pressed in", [&] { displace(k, 2, -0.001); });
    tamper("a node of the interface lifted", [&] { displace(k, 2, 0.001); });
    tamper("a node of the interface moved along it", [&] { displace(k, 0, 0.001); });
    tamper("a node moved by a hundred-thousandth", [&] { displace(k, 2, 1e-5); });
    tamper("the upper block lifted off", [&] { displace_body(1, 2, 0.1); });
    tamper("the upper block let down through the lower one", [&] { displace_body(1, 2, -2.); });
    tamper("the upper block pressed in", [&] { displace_body(1, 2, -0.2); });
    tamper("the upper block pressed in by 0.07 faces", [&] { displace_body(1, 2, -0.025); });
    tamper("the upper block pressed in by 0.15 faces", [&] { displace_body(1, 2, -0.055); });
    tamper("the upper block pushed off sideways", [&] { displace_body(1, 0, 3.); });
    tamper("no pressure", [&] { scale_multipliers(1, 0.); });
    tamper("pressures a thousandth too large", [&] { scale_multipliers(1, 1.001); });
    tamper("tension", [&] { scale_multipliers(1, -1.); });
    tamper("no friction", [&] { scale_multipliers(2, 0.); });
    tamper("friction the other way", [&] { scale_multipliers(2, -1.); });
    tamper("friction beyond the cone", [&] { scale_multipliers(2, 1.5); });
    tamper("everything open",
           [&]
           {
             for (auto &closed : now.contact.statuses.contact)
               closed = false;
           });
    tamper("sticking where it slips, and slipping where it sticks",
           [&]
           {
             for (auto &stick : now.contact.statuses.stick)
               stick = !stick;
           });
    tamper("thresholds of twice the pressure",
           [&]
           {
             for (auto &threshold : now.contact.statuses.threshold)
               threshold *= 2.;
           });
    tamper("the state before", [&] { now = run.states.committed; });
    tamper("a corner of the interface thrown through the lower block", [&] { displace(corner, 2, -1.); });
  }
}
