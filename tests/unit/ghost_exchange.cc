// Values of owners arrive at ghosts and those of ghosts are added, in one step and in two; messages that are still on
// their way to a rank that is late stay as they were sent when the next ones are.

#include "../cases.h"

#include "parallel/ghost_exchange.h"

#include <deal.II/base/mpi.h>

#include <chrono>
#include <thread>
#include <utility>

using namespace Cases;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       rank = dealii::Utilities::MPI::this_mpi_process(world()),
                     n_ranks                    = dealii::Utilities::MPI::n_mpi_processes(world());
  // each rank owns a row of objects, and has the last one before and the first two behind them as ghosts
  constexpr unsigned int n_own = 5, n_components = 400; // messages longer than what MPI takes at once
  std::vector<DoFIndex>  start(1, 0), ghosts;
  for (unsigned int r = 0; r < n_ranks; ++r)
    start.push_back(start.back() + n_own);
  if (rank > 0)
    ghosts.push_back(start[rank] - 1);
  if (rank + 1 < n_ranks)
    ghosts.insert(ghosts.end(), {start[rank + 1], start[rank + 1] + 1});
  const auto number = [&](const unsigned int i) { return i < n_own ? start[rank] + i : ghosts[i - n_own]; };
  const auto value  = [&](const unsigned int i, const unsigned int c, const unsigned int round)
  { return 1. + number(i) + c / 1024. + 100. * round; }; // exact

  Nodus::GhostExchange first = Nodus::GhostExchange::numbered_through(start, ghosts, world()),
                       other = Nodus::GhostExchange::numbered_through(start, ghosts, world());
  std::vector<double> owned(n_components * n_own), received(n_components * ghosts.size()), unused(received);
  const auto          fill = [&](const unsigned int round)
  {
    for (unsigned int i = 0; i < n_own; ++i)
      for (unsigned int c = 0; c < n_components; ++c)
        owned[n_components * i + c] = value(i, c, round);
  };
  const auto arrived = [&](const unsigned int round)
  {
    bool right = true;
    for (unsigned int g = 0; g < ghosts.size(); ++g)
      for (unsigned int c = 0; c < n_components; ++c)
        right = right && received[n_components * g + c] == value(n_own + g, c, round);
    return dealii::Utilities::MPI::min(right ? 1 : 0, world()) != 0;
  };

  fill(0);
  first.fetch(owned.data(), received.data(), n_components);
  check("fetch", arrived(0));

  bool right = true;
  for (unsigned int round = 1; round <= 20; ++round)
  {
    fill(round);
    first.start_fetch(owned.data(), n_components);
    if (round % n_ranks == rank)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    first.finish_fetch(received.data(), n_components);
    for (unsigned int g = 0; g < ghosts.size(); ++g)
      for (unsigned int c = 0; c < n_components; ++c)
        right = right && received[n_components * g + c] == value(n_own + g, c, round);
  }
  check("many in turn, ranks late in turn", dealii::Utilities::MPI::min(right ? 1 : 0, world()) != 0);

  fill(30);
  first.start_fetch(owned.data(), n_components);
  fill(31);
  other.start_fetch(owned.data(), n_components);
  Nodus::GhostExchange moved(std::move(first));
  other.finish_fetch(received.data(), n_components);
  check("two at once: the second", arrived(31));
  moved.finish_fetch(received.data(), n_components);
  check("two at once: the first, moved meanwhile", arrived(30));

  // ghosts hold their number; an owner gets one for each rank that has it
  for (unsigned int g = 0; g < ghosts.size(); ++g)
    for (unsigned int c = 0; c < n_components; ++c)
      received[n_components * g + c] = ghosts[g] + c;
  std::fill(owned.begin(), owned.end(), 0.5);
  moved.add(received.data(), owned.data(), n_components);
  right = true;
  for (unsigned int i = 0; i < n_own; ++i)
  {
    const unsigned int copies = (i + 1 == n_own && rank + 1 < n_ranks) + (i < 2 && rank > 0);
    for (unsigned int c = 0; c < n_components; ++c)
      right = right && owned[n_components * i + c] == 0.5 + copies * (number(i) + c);
  }
  check("add", dealii::Utilities::MPI::min(right ? 1 : 0, world()) != 0);

  std::vector<DoFIndex>     keys;
  std::vector<unsigned int> owners;
  for (unsigned int i = 0; i < n_own + ghosts.size(); ++i)
  {
    keys.push_back(number(i));
    owners.push_back(number(i) / n_own);
  }
  std::vector<double>        values(keys.size(), 1.), wanted(keys.begin(), keys.end());
  const Nodus::GhostExchange by_key(keys, owners, world());
  by_key.sum(values);
  right = true;
  for (unsigned int i = 0; i < keys.size(); ++i)
  {
    const unsigned int place = keys[i] % n_own, owner = owners[i];
    right = right && values[i] == 1. + (place + 1 == n_own && owner + 1 < n_ranks) + (place < 2 && owner > 0);
  }
  check("sum", dealii::Utilities::MPI::min(right ? 1 : 0, world()) != 0);
  std::fill(wanted.begin() + n_own, wanted.end(), -1.);
  by_key.update(wanted);
  check("update",
        dealii::Utilities::MPI::min(std::equal(wanted.begin(), wanted.end(), keys.begin()) ? 1 : 0, world()) != 0);
}
