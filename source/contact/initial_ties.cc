#include "contact/initial_ties.h"
#include "base/text.h"
#include "contact/loci.h"
#include "contact/pairing.h"
#include "contact/status.h"
#include "contact/surface.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <limits>

namespace Nodus
{
  namespace
  {
    /// Sites of a tied pair, of all ranks.
    struct Ties
    {
      unsigned int              sites = 0, untied = 0, alone = 0; ///< alone: without a master point
      std::vector<unsigned int> far;                              ///< on this rank: untied with a master point
      double                    nearest = std::numeric_limits<double>::max(); ///< of these [length]
    };

    Ties ties_of(const unsigned int         pair,
                 const ContactSurfaces     &surfaces,
                 const Pairing             &pairing,
                 const Status              &status,
                 const std::vector<double> &distance)
    {
      Ties ties;
      for (unsigned int s = 0; s < distance.size(); ++s)
      {
        if (surfaces.pair(s) != pair || !surfaces.is_owned(s) || !surfaces.has_status(s))
          continue;
        ++ties.sites;
        if (status.contact(s))
          continue;
        ++ties.untied;
        if (pairing[s].found)
        {
          ties.far.push_back(s);
          ties.nearest = std::min(ties.nearest, std::abs(distance[s]));
        }
        else
          ++ties.alone;
      }
      const MPI_Comm communicator = surfaces.layout().communicator;
      for (unsigned int *count : {&ties.sites, &ties.untied, &ties.alone})
        *count = dealii::Utilities::MPI::sum(*count, communicator);
      ties.nearest = dealii::Utilities::MPI::min(ties.nearest, communicator);
      return ties;
    }
  } // namespace

  std::vector<std::string> describe_untied(const std::vector<ContactPairParameters> &pairs,
                                           const ContactSurfaces                    &surfaces,
                                           const Pairing                            &pairing,
                                           const Status                             &status,
                                           const std::vector<double>                &distance,
                                           const double                              t)
  {
    std::vector<std::string> warnings;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (pairs[p].contact_law != ContactPairParameters::ContactLaw::tied || pairs[p].active_from != t)
        continue;
      const Ties ties = ties_of(p, surfaces, pairing, status, distance);
      if (ties.untied == 0)
        continue;
      const std::string sites  = surfaces.has_points(p) ? "integration points" : "slave nodes";
      const std::string key    = "'Contact pair " + std::to_string(p + 1) + "/Adjustment distance'";
      const auto        first  = loci(pairs, surfaces, ties.far, 1);
      std::string       reason = ties.alone > 0 ? std::to_string(ties.alone) + " without a master point" : "";
      if (!first.empty())
        reason += text(ties.alone > 0 ? "; " : "",
                       "the nearest is ",
                       ties.nearest,
                       " from the master, the tying distance is ",
                       status.closing_distance(p),
                       "; first ",
                       first.front());
      if (ties.untied == ties.sites)
        throw InputError(text("nothing of ",
                              pair_label(pairs, p),
                              " is tied, none of its ",
                              ties.sites,
                              " ",
                              sites,
                              ": ",
                              reason,
                              "; raise ",
                              key,
                              ", or look whether its boundary ids are right"));
      warnings.push_back(text(pair_label(pairs, p),
                              ": ",
                              ties.untied,
                              " of ",
                              ties.sites,
                              " ",
                              sites,
                              " are not tied: ",
                              reason,
                              " (",
                              key,
                              ")"));
    }
    return warnings;
  }
} // namespace Nodus
