#include "output/diagnosis/suspected_causes.h"

#include <algorithm>
#include <cmath>

// Why a loop on statuses, thresholds or the geometry did not end.

namespace Nodus
{
  namespace Suspects
  {
    namespace
    {
      std::vector<double> values_of(const std::vector<Diagnosis::Pass> &passes, const std::string &loop)
      {
        std::vector<double> values;
        for (const auto &pass : passes)
          if (pass.loop == loop)
          {
            if (pass.number == 1)
              values.clear(); // the loop began anew
            values.push_back(pass.value);
          }
        return values;
      }

      /// Another weight of gaps or slips where statuses are tested.
      void
      add_augmentation(const Parameters &parameters, const unsigned int pair, const bool slides, SuspectedCause &cause)
      {
        using Pair          = ContactPairParameters;
        const Pair  &keys   = parameters.contact_pairs[pair];
        const double factor = slides ? keys.tangential_augmentation_factor : keys.normal_augmentation_factor;
        // with consistent weights a softer test does not help, a harder one does (contrib/studies/robustness)
        const bool mixed = !slides && keys.scheme == Pair::Scheme::nodal && keys.weights == Pair::Weights::consistent;
        cause.changes.push_back(
            {in_pair(pair, slides ? "Tangential augmentation factor" : "Normal augmentation factor"),
             text(factor),
             text(mixed ? 10. * factor : factor / 10.),
             text("statuses are tested ",
                  mixed ? "by gaps more than by pressures" : "more softly",
                  "; the solution does not depend on it")});
      }
    } // namespace

    void add_status_cycle(const Parameters      &parameters,
                          const History         &history,
                          const FailureEvidence &evidence,
                          Causes                &causes)
    {
      SuspectedCause cause{"statuses change back and forth", {}, {}};
      const auto    &sites   = evidence.changing_sites;
      unsigned int   changes = 0, iterations = 0, period = 0, friction = 0;
      for (const auto &i : history.iterations)
        if (i.norms.changes > 0)
        {
          changes += i.norms.changes;
          ++iterations;
        }
      for (const auto &pass : history.passes)
        if (pass.loop == "status" && pass.value > 0.)
        {
          changes += static_cast<unsigned int>(pass.value);
          ++iterations;
        }
      for (const auto &site : sites)
      {
        period = std::max(period, site.ledger.period);
        friction += site.ledger.last == Contradiction::over_cone || site.ledger.last == Contradiction::against_slip;
      }
      cause.evidence.push_back(text(changes,
                                    " changes at ",
                                    evidence.n_changed_sites,
                                    " sites in ",
                                    iterations,
                                    " of the ",
                                    history.iterations.size(),
                                    " iterations and passes of the last attempt"));
      if (period > 0)
        cause.evidence.push_back(text("the same statuses came back after ", period, " tests"));
      unsigned int pair = 0;
      if (!sites.empty())
      {
        pair = sites.front().pair;
        cause.evidence.push_back(text("most often, ",
                                      sites.front().ledger.changes,
                                      " times, at (",
                                      sites.front().X,
                                      ") of ",
                                      pair_name(parameters, pair)));
        cause.evidence.push_back(
            friction * 2 > sites.size()
                ? text(friction, " of the ", sites.size(), " worst went between stick and slip")
                : text(sites.size() - friction, " of the ", sites.size(), " worst went between open and closed"));
      }
      if (pair < parameters.contact_pairs.size() &&
          parameters.contact_pairs[pair].status_test == ContactPairParameters::StatusTest::raw)
        cause.changes.push_back({in_pair(pair, "Status test"),
                                 "raw",
                                 "weighted",
                                 "multipliers of neighbours swing about the pressure, their weighted mean does not"});
      bool shared = false; // augmentation has helped there where smaller increments have not
      if (pair < parameters.contact_pairs.size())
      {
        const std::size_t before = cause.changes.size();
        add_own_gaps(parameters, pair, cause);
        shared = cause.changes.size() > before;
      }
      if (!shared)
        add_smaller_increments(parameters, history, cause);
      if (pair < parameters.contact_pairs.size())
        add_augmentation(parameters, pair, friction * 2 > sites.size(), cause);
      if (shared)
        add_smaller_increments(parameters, history, cause);
      add_newton_mode("Status loop", parameters.status_loop, cause);
      causes.push_back(cause);
    }

    void add_threshold_loop(const Parameters &parameters, const History &history, Causes &causes)
    {
      const std::vector<double> values =
          values_of(history.threshold_passes.empty() ? history.passes : history.threshold_passes, "threshold");
      const double   rate = contraction(values);
      const double   last = values.empty() ? 0. : values.back();
      SuspectedCause cause{rate < no_contraction ? "the threshold loop converges slowly"
                                                 : "the friction threshold loop does not contract",
                           {},
                           {}};
      cause.evidence.push_back("changes of the threshold in the last passes: " + joined(last_of(values, 6)));
      cause.evidence.push_back(text("each pass multiplies them by ", rate, " (below 1 it converges)"));
      double friction = 0.;
      for (const auto &pair : parameters.contact_pairs)
        friction = std::max(friction, pair.friction_coefficient);
      cause.evidence.push_back(text("largest friction coefficient ",
                                    friction,
                                    ": the loop contracts about like the coefficient over the slope along which the "
                                    "load presses the bodies together"));
      add_newton_mode("Threshold loop", parameters.threshold_loop, cause);
      add_more_passes("Threshold loop/Maximum passes",
                      parameters.threshold_loop.maximum_passes,
                      rate,
                      last,
                      parameters.threshold_loop.tolerance,
                      cause);
      for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
        if (parameters.contact_pairs[p].friction_coefficient > 0.)
          add_own_gaps(parameters, p, cause);
      add_smaller_increments(parameters, history, cause);
      causes.push_back(cause);
    }

    void add_geometry_loop(const Parameters      &parameters,
                           const History         &history,
                           const FailureEvidence &evidence,
                           Causes                &causes)
    {
      const bool                cycle  = evidence.kind == Kind::geometry_cycle;
      const std::vector<double> values = values_of(history.passes, "geometry");
      const double              rate   = contraction(values);
      const double              last   = values.empty() ? 0. : values.back();
      SuspectedCause cause{cycle ? "normals jump between the facets of the master: the geometry loop comes back to the "
                                   "pass before the last one"
                                 : "the geometry loop does not converge",
                           {},
                           {}};
      cause.evidence.push_back("criterion in the last passes: " + joined(last_of(values, 6)) +
                               text(" (it ends at ", parameters.geometry_loop.tolerance, ')'));
      if (!cycle)
        cause.evidence.push_back(text("each pass multiplies it by ", rate, " (below 1 it converges)"));
      if (!history.passes.empty())
        cause.evidence.push_back("worst at the surface node with the reference position " +
                                 history.passes.back().worst);
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
      {
        const auto &pair = parameters.contact_pairs[p];
        cause.evidence.push_back(text(pair_name(parameters, p),
                                      ": surface ",
                                      text_of(pair.surface),
                                      ", slave nodes slide up to ",
                                      evidence.pairs[p].sliding,
                                      " faces in the increment"));
        if (pair.normal == ContactPairParameters::Normal::master_facet)
          cause.changes.push_back(
              {in_pair(p, "Normal"), "master facet", "averaged", "normals do not jump across the edges"});
        if (pair.surface == ContactPairParameters::Surface::faceted)
          cause.changes.push_back({in_pair(p, "Surface"), "faceted", "smoothed", "there are no edges to cross"});
      }
      add_newton_mode("Geometry loop", parameters.geometry_loop, cause);
      add_more_passes("Geometry loop/Maximum passes",
                      parameters.geometry_loop.maximum_passes,
                      rate,
                      last,
                      parameters.geometry_loop.tolerance,
                      cause);
      add_smaller_increments(parameters, history, cause);
      causes.push_back(cause);
    }
  } // namespace Suspects
} // namespace Nodus
