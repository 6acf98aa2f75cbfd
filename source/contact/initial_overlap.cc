#include "contact/initial_overlap.h"
#include "contact/loci.h"
#include "contact/pairing.h"
#include "contact/surface.h"

#include <deal.II/base/mpi.h>

#include <sstream>

namespace Nodus
{
  void refuse_overlap(const std::vector<ContactPairParameters> &pairs,
                      const ContactSurfaces                    &surfaces,
                      const Pairing                            &pairing,
                      const std::vector<double>                &distance)
  {
    std::vector<double>                    deepest(pairs.size(), 0.);
    std::vector<std::vector<unsigned int>> where(pairs.size());
    for (unsigned int s = 0; s < distance.size(); ++s)
    {
      const unsigned int p = surfaces.pair(s);
      if (surfaces.is_owned(s) && surfaces.has_status(s) && pairing[s].found && distance[s] > deepest[p])
      {
        deepest[p] = distance[s];
        where[p]   = {s};
      }
    }
    const MPI_Comm communicator = surfaces.layout().communicator;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      const auto  &start = pairs[p].start;
      const double limit = start.overclosure_limit > 0. ? start.overclosure_limit : 0.5 * surfaces.face_size(p);
      const auto   worst = dealii::Utilities::MPI::min_max_avg(deepest[p], communicator);
      if (worst.max <= limit)
        continue;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) != worst.max_index)
        where[p].clear();
      std::ostringstream message;
      message << "the bodies overlap at the start: " << loci(pairs, surfaces, where[p], 1).front() << " is "
              << worst.max << " inside the master, the limit is " << limit
              << "; move the bodies apart, or raise 'Contact pair " << p + 1 << "/Overclosure limit' if this is meant";
      throw InputError(message.str());
    }
  }
} // namespace Nodus
