#include "contact/second_pass.h"
#include "contact/surface.h"
#include "mesh/region.h"

#include <memory>

namespace Nodus
{
  std::string pair_label(const std::vector<ContactPairParameters> &pairs, const unsigned int pair)
  {
    return "Contact pair " + std::to_string(given_pair(pairs, pair) + 1) +
           (pairs[pair].name.empty() ? "" : " ('" + pairs[pair].name + "')");
  }

  void
  balance_contact(const std::vector<ContactPairParameters> &pairs, const dealii::Mapping<dim> &mapping, Bodies &bodies)
  {
    const auto slaves = std::make_shared<std::vector<Region>>();
    for (unsigned int p = 0; p < pairs.size(); ++p)
      slaves->emplace_back(pairs[p].slave, bodies, pair_label(pairs, p) + ", slave");
    bodies.balance(
        [slaves, &mapping](const Bodies::Triangulation::cell_iterator &cell)
        {
          unsigned int weight = Bodies::cell_weight;
          for (const unsigned int f : cell->face_indices())
            for (const Region &region : *slaves)
              weight +=
                  cell->face(f)->at_boundary() && region.selects_face(mapping, cell, f) ? Bodies::slave_face_weight : 0;
          return weight;
        });
  }
} // namespace Nodus
