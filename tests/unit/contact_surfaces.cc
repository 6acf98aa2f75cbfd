// The parts of the contact surfaces that ranks hold: a strip on a longer strip, both much longer than wide. On four
// ranks none holds much more than half of the faces; partners are right before and after the upper strip has moved by
// several faces; ghosts are the same objects as those of their owners.

#include "../contact_fixture.h"

#include <algorithm>

using namespace Cases;
using dealii::Utilities::MPI::max;
using dealii::Utilities::MPI::min;
using dealii::Utilities::MPI::sum;

namespace
{
  constexpr unsigned int n_slave = 48, n_master = 64; // along the strip, two across
  const MPI_Comm         communicator = MPI_COMM_WORLD;

  void check_part(ContactFixture &f, const double shift)
  {
    const ContactSurfaces &surfaces = *f.surfaces;
    Vector                 u(surfaces.layout().owned[0], communicator);
    for (const auto &node : surfaces.nodes())
      if (surfaces.layout().owned[0].is_element(node.dofs[0]) && node.X[2] > 1.05)
        u(node.dofs[0]) = shift;
    u.compress(dealii::VectorOperation::insert);
    const bool fetched = f.surfaces->fetch_masters(u, {});
    const bool ranks   = dealii::Utilities::MPI::n_mpi_processes(communicator) > 1;
    check("  masters are fetched anew where there are ranks and the strip has moved",
          fetched == (ranks && shift != 0.));
    std::vector<Vector3> nodal;
    surfaces.gather(u, nodal);
    f.pair_at(surfaces.positions(nodal));
    f.state.x = f.paired_at;

    const unsigned int n_faces = surfaces.slave_faces(0).size() + surfaces.master_faces(0).size();
    const double       largest = max(double(n_faces), communicator) / (2. * (n_slave + n_master));
    if (ranks)
      check("  no rank has more than 0.6 of the faces", largest < 0.6);
    else
      check("  no rank has more than 0.6 of the faces", largest == 1.);

    // master face number: cells of the strip come in any order, so compare positions
    unsigned int wrong = 0;
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s))
      {
        const Point &x = f.paired_at[surfaces.slave_nodes()[s].node];
        if (!f.pairing[s].found)
        {
          ++wrong;
          continue;
        }
        const Projection &p = f.pairing[s].master;
        const Point       y = f.geometry->master[0].at(p.face, p.xi, p.eta).x;
        wrong += std::abs(y[0] - x[0]) + std::abs(y[1] - x[1]) > 1e-10 || std::abs(y[2] - 1.) > 1e-10;
        wrong += std::abs(f.assembler->distance(f.state, s)) > 10.; // has a row
      }
    check("  every slave node has its partner straight below", sum(wrong, communicator) == 0);

    // nodes of own faces have all that assembly asks for
    unsigned int missing = 0;
    const auto   rank    = dealii::Utilities::MPI::this_mpi_process(communicator);
    for (const auto &face : surfaces.slave_faces(0))
      if (face.owner == rank)
        for (const unsigned int n : face.nodes)
          missing += f.pairs[0].scheme == ContactPairParameters::Scheme::nodal &&
                     f.jump.begin(surfaces.slave_number(0, n)) == f.jump.end(surfaces.slave_number(0, n));
    check("  nodes of own faces have their jumps", sum(missing, communicator) == 0);
    double area = 0.;
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
      area += f.weights.area()[k];
    check("  areas of all nodes", sum(area, communicator), 48. * 2., 1e-12);

    std::vector<std::array<double, 3>> X;
    for (unsigned int k = 0; k < surfaces.slave_nodes().size(); ++k)
    {
      X.push_back({{0., 0., 0.}});
      for (unsigned int c = 0; c < 3 && surfaces.is_owned(k); ++c)
        X[k][c] = surfaces.nodes()[surfaces.slave_nodes()[k].node].X[c];
    }
    surfaces.slave_exchange().update(X);
    std::vector<double> ones(X.size(), 1.), copies(X.size(), 1.);
    surfaces.slave_exchange().sum(copies);
    surfaces.slave_exchange().update(ones);
    bool   same  = true;
    double total = 0.;
    for (unsigned int k = 0; k < X.size(); ++k)
    {
      same =
          same && Point(X[k][0], X[k][1], X[k][2]).distance(surfaces.nodes()[surfaces.slave_nodes()[k].node].X) < 1e-14;
      total += surfaces.is_owned(k) ? copies[k] : 0.;
    }
    check("  ghosts are their owners' nodes", min(int(same), communicator) == 1);
    check("  sums count every copy once", sum(double(X.size()), communicator) == sum(total, communicator));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Scheme = ContactPairParameters::Scheme;
  {
    // every cell of the upper strip has a slave face
    constexpr double with_face = 1. + double(Bodies::slave_face_weight) / Bodies::cell_weight;
    Bodies           bodies(
        {box("lower", "64,2,1", {0, 0, 0}, {64, 2, 1}, 1, 0), box("upper", "48,2,1", {0, 0, 1.1}, {48, 2, 2}, 1, 0)},
        communicator);
    balance_contact({pair(region(2, {z_minus}), region(1, {z_plus}))}, dealii::MappingQ<3>(1), bodies);
    double work = 0.;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        work += cell->material_id() == 1 ? with_face : 1.;
    const double mean = sum(work, communicator) / dealii::Utilities::MPI::n_mpi_processes(communicator);
    check("all cells are there", sum(work, communicator) == 128. + with_face * 96.);
    check("the busiest rank has at most 1.05 of the mean work", max(work, communicator) <= 1.05 * mean);
  }
  for (const auto scheme : {Scheme::nodal, Scheme::averaged})
  {
    if (root())
      std::cout << (scheme == Scheme::nodal ? "nodal" : "averaged") << std::endl;
    auto contact            = pair(region(2, {z_minus}), region(1, {z_plus}));
    contact.scheme          = scheme;
    contact.normal          = ContactPairParameters::Normal::averaged;
    contact.weights         = scheme == Scheme::nodal ? ContactPairParameters::Weights::consistent
                                                      : ContactPairParameters::Weights::nodal_quadrature;
    contact.search_distance = 2.;
    ContactFixture f(
        {box("lower", "64,2,1", {0, 0, 0}, {64, 2, 1}, 1, 0), box("upper", "48,2,1", {0, 0, 1.1}, {48, 2, 2}, 1, 0)},
        {contact},
        1);
    check_part(f, 0.);
    check_part(f, 7.3);
  }
}
