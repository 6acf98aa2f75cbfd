// One slave node through the status loop: what contradicts a status, what follows, what the ledger says. A node that
// opened in this loop and closes again slips: with stick on closing, stick that pulls the node open would cycle.

#include "../contact_fixture.h"

using namespace Cases;

namespace
{
  const char *name(const ContactStatus status)
  {
    return status == ContactStatus::open ? "open" : status == ContactStatus::slip ? "slip" : "stick";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ContactFixture                           fixture(
      {box("lower", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1, 0), box("upper", "1,1,1", {0, 0, 1}, {1, 1, 2}, 1, 0)},
      {pair(region(2, {z_minus}), region(1, {z_plus}), 0.5)},
      1);
  Status            &status = *fixture.status;
  const unsigned int n      = status.size();

  const auto step = [&](const std::string &what, const double pressure, const double distance, const double Lambda)
  {
    StatusInput input;
    input.pressure.assign(n, -1.);
    input.distance.assign(n, 0.);
    input.Lambda.assign(n, {{0., 0.}});
    input.slip.assign(n, {{0., 0.}});
    input.pressure[0]          = pressure;
    input.distance[0]          = distance;
    input.Lambda[0][0]         = Lambda;
    const auto          update = status.update(input);
    const StatusLedger &ledger = status.ledger(0);
    std::cout << what << ": " << name(status.status(0)) << ", changes " << ledger.changes << ", last contradiction "
              << static_cast<int>(ledger.last) << ", period " << update.period << (update.cycles ? ", cycles" : "")
              << std::endl;
  };
  for (unsigned int k = 0; k < n; ++k)
    status.assign(k, true, true, -1.);
  status.begin_increment();

  status.begin_loop();
  step("stick within the cone", -1., 0., 0.9);
  step("stick beyond the cone", -1., 0., 1.1);
  step("slip against the traction", -1., 0., 0.5);
  status.begin_loop();
  step("closed under tension", 1., 0., 0.);
  step("open and apart", 0., -0.1, 0.);
  step("open and penetrating, opened in this loop", 0., 0.1, 0.);
  step("under tension again", 1., 0., 0.);
  status.begin_loop();
  step("open and penetrating, open since before", 0., 0.1, 0.);
  std::cout << "cycle period in the ledger: " << status.ledger(0).period << ", of another node "
            << status.ledger(1).period << std::endl;
  status.begin_increment();
  std::cout << "next increment: changes " << status.ledger(0).changes << std::endl;
}
