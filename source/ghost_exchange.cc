#include <nodus/ghost_exchange.h>
#include <nodus/some_to_some.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    constexpr int tag = 4711;
  } // namespace

  GhostExchange::GhostExchange(const std::vector<DoFIndex>     &key,
                               const std::vector<unsigned int> &owner,
                               MPI_Comm                         communicator)
      : communicator_(communicator)
  {
    const unsigned int                                rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    Keys                                              wanted;
    std::map<unsigned int, std::vector<unsigned int>> ghosts;
    std::unordered_map<DoFIndex, unsigned int>        owned;
    for (unsigned int i = 0; i < key.size(); ++i)
      if (owner[i] == rank)
        owned.emplace(key[i], i);
      else
      {
        wanted[owner[i]].push_back(key[i]);
        ghosts[owner[i]].push_back(i);
      }
    connect(wanted,
            std::move(ghosts),
            [&](const DoFIndex k)
            {
              Assert(owned.count(k) == 1, dealii::ExcMessage("an owner does not have its own object"));
              return owned.at(k);
            });
  }

  GhostExchange GhostExchange::numbered_through(const std::vector<DoFIndex> &start,
                                                const std::vector<DoFIndex> &ghosts,
                                                const MPI_Comm               communicator)
  {
    GhostExchange      result;
    const unsigned int rank  = dealii::Utilities::MPI::this_mpi_process(communicator);
    const DoFIndex     first = start[rank];
    result.communicator_     = communicator;
    result.n_owned_          = start[rank + 1] - first;
    Keys                                              wanted;
    std::map<unsigned int, std::vector<unsigned int>> local;
    for (unsigned int g = 0; g < ghosts.size(); ++g)
    {
      const unsigned int owner = std::upper_bound(start.begin(), start.end(), ghosts[g]) - start.begin() - 1;
      wanted[owner].push_back(ghosts[g]);
      local[owner].push_back(result.n_owned_ + g);
    }
    result.connect(wanted, std::move(local), [first](const DoFIndex k) { return k - first; });
    return result;
  }

  void GhostExchange::connect(const Keys                                       &wanted,
                              std::map<unsigned int, std::vector<unsigned int>> ghosts,
                              const std::function<unsigned int(DoFIndex)>      &find)
  {
    std::map<unsigned int, Neighbour> neighbours;
    for (auto &[other, objects] : ghosts)
      neighbours[other].ghosts = std::move(objects);
    for (const auto &[other, keys] : some_to_some(communicator_, wanted))
      for (const DoFIndex k : keys)
        neighbours[other].owned.push_back(find(k));
    for (auto &[other, neighbour] : neighbours)
    {
      neighbour.rank = other;
      neighbours_.push_back(std::move(neighbour));
    }
  }

  void GhostExchange::exchange() const
  {
    requests_.clear();
    for (Neighbour &neighbour : neighbours_)
      if (!neighbour.incoming.empty())
      {
        requests_.emplace_back();
        MPI_Irecv(neighbour.incoming.data(),
                  neighbour.incoming.size(),
                  MPI_BYTE,
                  neighbour.rank,
                  tag,
                  communicator_,
                  &requests_.back());
      }
    for (const Neighbour &neighbour : neighbours_)
      if (!neighbour.outgoing.empty())
      {
        requests_.emplace_back();
        MPI_Isend(neighbour.outgoing.data(),
                  neighbour.outgoing.size(),
                  MPI_BYTE,
                  neighbour.rank,
                  tag,
                  communicator_,
                  &requests_.back());
      }
    MPI_Waitall(requests_.size(), requests_.data(), MPI_STATUSES_IGNORE);
  }

  void GhostExchange::copy(const void *const  owned,
                           void *const        ghosts,
                           const unsigned int first_ghost,
                           const std::size_t  bytes_per_object) const
  {
    for (Neighbour &neighbour : neighbours_)
    {
      neighbour.incoming.resize(neighbour.ghosts.size() * bytes_per_object);
      neighbour.outgoing.resize(neighbour.owned.size() * bytes_per_object);
      char *to = neighbour.outgoing.data();
      for (const unsigned int i : neighbour.owned)
      {
        std::memcpy(to, static_cast<const char *>(owned) + i * bytes_per_object, bytes_per_object);
        to += bytes_per_object;
      }
    }
    exchange();
    for (const Neighbour &neighbour : neighbours_)
    {
      const char *from = neighbour.incoming.data();
      for (const unsigned int i : neighbour.ghosts)
      {
        std::memcpy(static_cast<char *>(ghosts) + (i - first_ghost) * bytes_per_object, from, bytes_per_object);
        from += bytes_per_object;
      }
    }
  }

  void GhostExchange::add(const double *const ghosts,
                          double *const       owned,
                          const unsigned int  first_ghost,
                          const unsigned int  n_components) const
  {
    const std::size_t bytes_per_object = n_components * sizeof(double);
    for (Neighbour &neighbour : neighbours_)
    {
      neighbour.incoming.resize(neighbour.owned.size() * bytes_per_object);
      neighbour.outgoing.resize(neighbour.ghosts.size() * bytes_per_object);
      char *to = neighbour.outgoing.data();
      for (const unsigned int i : neighbour.ghosts)
      {
        std::memcpy(to, ghosts + std::size_t(i - first_ghost) * n_components, bytes_per_object);
        to += bytes_per_object;
      }
    }
    exchange();
    for (const Neighbour &neighbour : neighbours_)
    {
      const char *from = neighbour.incoming.data();
      for (const unsigned int i : neighbour.owned)
        for (unsigned int c = 0; c < n_components; ++c)
        {
          double part;
          std::memcpy(&part, from, sizeof(double));
          owned[std::size_t(i) * n_components + c] += part;
          from += sizeof(double);
        }
    }
  }

  void GhostExchange::sum(std::vector<double> &values, const unsigned int n_components) const
  {
    add(values.data(), values.data(), 0, n_components);
    update(values, n_components);
  }

  void GhostExchange::fetch(const double *const owned, double *const ghosts, const unsigned int n_components) const
  {
    copy(owned, ghosts, n_owned_, n_components * sizeof(double));
  }

  void GhostExchange::add(const double *const ghosts, double *const owned, const unsigned int n_components) const
  {
    add(ghosts, owned, n_owned_, n_components);
  }

  std::vector<std::vector<double>>
  GhostExchange::fetch_lists(const std::function<void(unsigned int, std::vector<double> &)> &append) const
  {
    std::map<unsigned int, std::vector<double>> outgoing; // the length of each list, and the list
    std::size_t                                 n_ghosts = 0;
    for (const Neighbour &neighbour : neighbours_)
    {
      n_ghosts += neighbour.ghosts.size();
      for (const unsigned int i : neighbour.owned)
      {
        std::vector<double> &numbers = outgoing[neighbour.rank];
        const std::size_t    length  = numbers.size();
        numbers.push_back(0.);
        append(i, numbers);
        numbers[length] = numbers.size() - length - 1;
      }
    }
    const auto                       incoming = some_to_some(communicator_, outgoing);
    std::vector<std::vector<double>> lists(n_ghosts);
    for (const Neighbour &neighbour : neighbours_)
      if (const auto from = incoming.find(neighbour.rank); from != incoming.end())
      {
        const double *p = from->second.data();
        for (const unsigned int i : neighbour.ghosts)
        {
          const auto length = static_cast<std::size_t>(*p++);
          lists[i - n_owned_].assign(p, p + length);
          p += length;
        }
      }
    return lists;
  }
} // namespace Nodus
