#include <nodus/contact/ghost_exchange.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <cstring>
#include <map>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    constexpr int tag = 4711;

    /// Sends to and receives from every neighbour; @p incoming has the sizes that arrive.
    void exchange(const std::vector<unsigned int> &ranks,
                  std::vector<std::vector<char>>  &outgoing,
                  std::vector<std::vector<char>>  &incoming,
                  const MPI_Comm                   communicator)
    {
      std::vector<MPI_Request> requests;
      requests.reserve(2 * ranks.size());
      for (unsigned int i = 0; i < ranks.size(); ++i)
        if (!incoming[i].empty())
        {
          requests.emplace_back();
          MPI_Irecv(incoming[i].data(), incoming[i].size(), MPI_BYTE, ranks[i], tag, communicator, &requests.back());
        }
      for (unsigned int i = 0; i < ranks.size(); ++i)
        if (!outgoing[i].empty())
        {
          requests.emplace_back();
          MPI_Isend(outgoing[i].data(), outgoing[i].size(), MPI_BYTE, ranks[i], tag, communicator, &requests.back());
        }
      MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    }
  } // namespace

  GhostExchange::GhostExchange(const std::vector<DoFIndex>     &key,
                               const std::vector<unsigned int> &owner,
                               MPI_Comm                         communicator)
      : communicator_(communicator)
  {
    const unsigned int                            rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    std::map<unsigned int, std::vector<DoFIndex>> wanted;
    std::map<unsigned int, Neighbour>             neighbours;
    std::unordered_map<DoFIndex, unsigned int>    owned;
    for (unsigned int i = 0; i < key.size(); ++i)
      if (owner[i] == rank)
        owned.emplace(key[i], i);
      else
      {
        wanted[owner[i]].push_back(key[i]);
        neighbours[owner[i]].ghosts.push_back(i);
      }
    for (const auto &[other, keys] : dealii::Utilities::MPI::some_to_some(communicator, wanted))
      for (const DoFIndex k : keys)
      {
        Assert(owned.count(k) == 1, dealii::ExcMessage("an owner does not have its own object"));
        neighbours[other].owned.push_back(owned.at(k));
      }
    for (auto &[other, neighbour] : neighbours)
    {
      neighbour.rank = other;
      neighbours_.push_back(std::move(neighbour));
    }
  }

  void GhostExchange::copy(void *const values, const std::size_t bytes_per_object) const
  {
    char *const                    bytes = static_cast<char *>(values);
    std::vector<unsigned int>      ranks;
    std::vector<std::vector<char>> outgoing, incoming;
    for (const Neighbour &neighbour : neighbours_)
    {
      ranks.push_back(neighbour.rank);
      outgoing.emplace_back(neighbour.owned.size() * bytes_per_object);
      for (unsigned int j = 0; j < neighbour.owned.size(); ++j)
        std::memcpy(outgoing.back().data() + j * bytes_per_object,
                    bytes + neighbour.owned[j] * bytes_per_object,
                    bytes_per_object);
      incoming.emplace_back(neighbour.ghosts.size() * bytes_per_object);
    }
    exchange(ranks, outgoing, incoming, communicator_);
    for (unsigned int i = 0; i < ranks.size(); ++i)
      for (unsigned int j = 0; j < neighbours_[i].ghosts.size(); ++j)
        std::memcpy(bytes + neighbours_[i].ghosts[j] * bytes_per_object,
                    incoming[i].data() + j * bytes_per_object,
                    bytes_per_object);
  }

  void GhostExchange::sum(std::vector<double> &values, const unsigned int n_components) const
  {
    const std::size_t              bytes_per_object = n_components * sizeof(double);
    std::vector<unsigned int>      ranks;
    std::vector<std::vector<char>> outgoing, incoming;
    for (const Neighbour &neighbour : neighbours_)
    {
      ranks.push_back(neighbour.rank);
      outgoing.emplace_back(neighbour.ghosts.size() * bytes_per_object);
      for (unsigned int j = 0; j < neighbour.ghosts.size(); ++j)
        std::memcpy(outgoing.back().data() + j * bytes_per_object,
                    values.data() + neighbour.ghosts[j] * n_components,
                    bytes_per_object);
      incoming.emplace_back(neighbour.owned.size() * bytes_per_object);
    }
    exchange(ranks, outgoing, incoming, communicator_);
    // ranks in ascending order, so that a run repeats to the last digit
    for (unsigned int i = 0; i < ranks.size(); ++i)
      for (unsigned int j = 0; j < neighbours_[i].owned.size(); ++j)
        for (unsigned int c = 0; c < n_components; ++c)
        {
          double part;
          std::memcpy(&part, incoming[i].data() + j * bytes_per_object + c * sizeof(double), sizeof(double));
          values[neighbours_[i].owned[j] * n_components + c] += part;
        }
    update(values, n_components);
  }
} // namespace Nodus
