// A node of the slab hangs over the rim of the block, which is the master and is moved by hand. It gets a partner
// within the projection tolerance and keeps it up to twice that, so that contact cannot push it to and fro across the
// limit. A node that is below the block's surface and beyond its rim has slid off: it gets no partner until it is above
// again or the rim has passed it, but keeps the one that it has.

#include "../contact_fixture.h"

using namespace Cases;

namespace
{
  /// Whether the node at (1, 2) has a partner when the block has moved by @p shift along x and down by @p depth.
  bool paired(ContactFixture &fixture, const double shift, const double depth = 0.)
  {
    std::vector<Point> x = fixture.state.x;
    std::vector<bool>  slave(x.size(), false);
    for (const auto &node : fixture.surfaces->slave_nodes())
      slave[node.node] = true;
    for (unsigned int i = 0; i < x.size(); ++i)
      if (!slave[i])
      {
        x[i][0] += shift;
        x[i][2] -= depth;
      }
    fixture.pair_at(x);
    for (unsigned int k = 0; k < fixture.surfaces->slave_nodes().size(); ++k)
      if (fixture.surfaces->site_position(k).distance(Point(1, 2, 0)) < 1e-12)
        return fixture.pairing[k].found;
    return false;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  // faces of the block: length 1; its rim is at x = 1 plus the overhang
  ContactFixture fixture(
      {box("slab", "4,4,1", {0, 0, -1}, {4, 4, 0}, 1, 0.3), box("block", "2,2,1", {1, 1, 0}, {3, 3, 1}, 1, 0.3)},
      {pair(region(1, {z_plus}), region(2, {z_minus}))},
      1);
  const double tolerance = fixture.pairs[0].projection_tolerance;
  fixture.pairing.set_partnered({});
  check("beyond the tolerance: none", !paired(fixture, 1.5 * tolerance));
  check("within: one", paired(fixture, 0.9 * tolerance));
  check("beyond again: kept", paired(fixture, 1.5 * tolerance));
  check("beyond twice the tolerance: none", !paired(fixture, 2.1 * tolerance));
  check("back: none", !paired(fixture, 1.5 * tolerance));
  fixture.pairing.set_partnered(std::vector<char>(fixture.surfaces->n_sites(), 1));
  check("with a partner from before: kept", paired(fixture, 1.5 * tolerance));
  check("and pushed in: kept", paired(fixture, 1.5 * tolerance, 4. * tolerance));
  check("off the rim: none", !paired(fixture, 2.1 * tolerance, 4. * tolerance));
  check("beside the block: none", !paired(fixture, 0.5 * tolerance, 4. * tolerance));
  check("just beside: one", paired(fixture, 0.5 * tolerance, 0.5 * tolerance));
  fixture.pairing.set_partnered({});
  check("rims that are flush: one", paired(fixture, 1e-6 * tolerance, 4. * tolerance));
  fixture.pairing.set_partnered({});
  check("passed by the rim: one", paired(fixture, -0.5 * tolerance, 4. * tolerance));
}
