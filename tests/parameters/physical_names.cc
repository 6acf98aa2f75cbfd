// Names of physical groups instead of ids: what named_ids.prm selects by name is selected by number, too, on one
// rank and on several. The names stand for other ids in the file of either body.

#include "../cases.h"

#include "mesh/bodies.h"
#include "mesh/region.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  unsigned int faces(const RegionParameters &parameters, const Bodies &bodies)
  {
    const Region region(parameters, bodies, "region");
    unsigned int n = 0;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          n += region.contains_face(cell, f);
    return dealii::Utilities::MPI::sum(n, world());
  }

  std::string numbers_of(const std::vector<unsigned int> &ids)
  {
    std::string text;
    for (const unsigned int id : ids)
      text += (text.empty() ? "" : " ") + std::to_string(id);
    return text.empty() ? "none" : text;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Parameters                         named = Parameters::read(SOURCE_DIR "/named_ids.prm"),
                   numbers                       = Parameters::read(SOURCE_DIR "/named_ids.prm",
                                              {"Body 1/Volume ids=4",
                                                                     "Boundary condition 2/Boundary ids=1",
                                                                     "Boundary condition 3/Boundary ids=2",
                                                                     "Contact pair 1/Slave boundary ids=1",
                                                                     "Contact pair 1/Master boundary ids=3,2"});
  const Bodies bodies(named.bodies, world());
  report("volumes of body 1", numbers_of(named.bodies[0].volume_ids));
  report("volumes of body 2", numbers_of(named.bodies[1].volume_ids));
  const auto show = [&](const std::string &name, const RegionParameters &region)
  {
    report(name,
           "ids " + numbers_of(region.boundary_ids) + ", as text " + region.ids_text() + ", " +
               std::to_string(faces(region, bodies)) + " faces");
    for (const auto &[body, ids] : region.ids_of_body)
      report("  of body " + std::to_string(body), numbers_of(ids));
  };
  for (const auto &condition : named.boundary_conditions)
    show(condition.name, condition.region);
  show("slave", named.contact_pairs[0].slave);
  show("master", named.contact_pairs[0].master);
  report("a checkpoint of one continues the other", named.model() == numbers.model() ? "yes" : "NO");
}
