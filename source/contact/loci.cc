#include "contact/loci.h"
#include "contact/second_pass.h"
#include "contact/surface.h"
#include "mesh/sides.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>

namespace Nodus
{
  double largest_difference(const ContactSurfaces &surfaces, const Vector &a, const Vector &b, std::string *const worst)
  {
    std::vector<Vector3> u, v;
    surfaces.gather(a, u);
    surfaces.gather(b, v);
    double      largest = 0.;
    std::string here    = u.empty() ? "" : coordinates(surfaces.nodes()[0].X);
    for (unsigned int i = 0; i < u.size(); ++i)
      if (const double difference = (u[i] - v[i]).norm(); difference > largest)
      {
        largest = difference;
        here    = coordinates(surfaces.nodes()[i].X);
      }
    const MPI_Comm communicator = surfaces.layout().communicator;
    const auto     all          = dealii::Utilities::MPI::min_max_avg(largest, communicator);
    if (worst != nullptr)
      *worst = dealii::Utilities::MPI::broadcast(communicator, here, all.max_index);
    return all.max;
  }

  std::vector<std::string> loci(const std::vector<ContactPairParameters> &pairs,
                                const ContactSurfaces                    &surfaces,
                                const std::vector<unsigned int>          &sites,
                                const unsigned int                        n)
  {
    std::vector<unsigned int> ordered(sites);
    std::sort(ordered.begin(),
              ordered.end(),
              [&](const auto a, const auto b) { return surfaces.order(a) < surfaces.order(b); });
    std::vector<std::pair<DoFIndex, std::string>> first;
    for (unsigned int i = 0; i < std::min<std::size_t>(n, ordered.size()); ++i)
    {
      const unsigned int site = ordered[i], p = surfaces.pair(site);
      const auto        &name = pairs[p].name;
      first.emplace_back(surfaces.order(site),
                         (surfaces.is_point(site) ? "integration point " : "slave node ") +
                             coordinates(surfaces.site_position(site)) + " of contact pair " +
                             std::to_string(given_pair(pairs, p) + 1) + (name.empty() ? "" : " ('" + name + "')"));
    }
    std::vector<std::pair<DoFIndex, std::string>> all;
    for (const auto &part : all_gather(surfaces.layout().communicator, first))
      all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    std::vector<std::string> found;
    for (unsigned int i = 0; i < std::min<std::size_t>(n, all.size()); ++i)
      found.push_back(all[i].second);
    return found;
  }
} // namespace Nodus
