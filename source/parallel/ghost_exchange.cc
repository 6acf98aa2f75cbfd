#include "parallel/ghost_exchange.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    constexpr int tag = 4711;
  } // namespace

  /// On their way to and from each neighbour. One takes a long message only when it waits for its own: what is sent
  /// stays in one of two sets of buffers until the exchange after the next.
  struct GhostExchange::Messages
  {
    struct Set
    {
      std::vector<std::vector<char>> buffers; ///< of each neighbour
      std::vector<MPI_Request>       requests;

      void complete()
      {
        MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
        requests.clear();
      }
    };
    Set                incoming;
    std::array<Set, 2> outgoing;
    unsigned int       turn = 0;

    explicit Messages(const std::size_t n_neighbours)
    {
      for (Set *const set : {&incoming, &outgoing[0], &outgoing[1]})
        set->buffers.resize(n_neighbours);
    }
    Messages(const Messages &) = delete;
    ~Messages()
    {
      for (Set &set : outgoing)
        set.complete();
    }
  };

  GhostExchange::GhostExchange()                                     = default;
  GhostExchange::GhostExchange(GhostExchange &&) noexcept            = default;
  GhostExchange &GhostExchange::operator=(GhostExchange &&) noexcept = default;
  GhostExchange::~GhostExchange()                                    = default;

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
    for (const auto &[other, keys] : sparse_exchange(communicator_, wanted))
      for (const DoFIndex k : keys)
        neighbours[other].owned.push_back(find(k));
    for (auto &[other, neighbour] : neighbours)
    {
      neighbour.rank = other;
      neighbours_.push_back(std::move(neighbour));
    }
    messages_ = std::make_unique<Messages>(neighbours_.size());
  }

  void GhostExchange::start(const Objects      from,
                            const void *const  values,
                            const unsigned int first,
                            const Objects      to,
                            const std::size_t  bytes_per_object) const
  {
    if (neighbours_.empty())
      return;
    Messages &messages     = *messages_;
    messages.turn          = 1 - messages.turn;
    Messages::Set &sent    = messages.outgoing[messages.turn];
    Messages::Set &awaited = messages.incoming;
    Assert(awaited.requests.empty(), dealii::ExcMessage("the exchange before has not been finished"));
    sent.complete();
    const auto add_message = [&](auto call, Messages::Set &set, const std::size_t k)
    {
      std::vector<char> &buffer = set.buffers[k];
      if (!buffer.empty())
        call(buffer.data(),
             buffer.size(),
             MPI_BYTE,
             neighbours_[k].rank,
             tag,
             communicator_,
             &set.requests.emplace_back());
    };
    for (std::size_t k = 0; k < neighbours_.size(); ++k)
    {
      awaited.buffers[k].resize((neighbours_[k].*to).size() * bytes_per_object);
      add_message(MPI_Irecv, awaited, k);
    }
    for (std::size_t k = 0; k < neighbours_.size(); ++k)
    {
      sent.buffers[k].resize((neighbours_[k].*from).size() * bytes_per_object);
      char *place = sent.buffers[k].data();
      for (const unsigned int i : neighbours_[k].*from)
      {
        std::memcpy(place, static_cast<const char *>(values) + (i - first) * bytes_per_object, bytes_per_object);
        place += bytes_per_object;
      }
      add_message(MPI_Isend, sent, k);
    }
  }

  void GhostExchange::finish_copy(void *const        ghosts,
                                  const unsigned int first_ghost,
                                  const std::size_t  bytes_per_object) const
  {
    if (neighbours_.empty())
      return;
    messages_->incoming.complete();
    for (std::size_t k = 0; k < neighbours_.size(); ++k)
    {
      const char *from = messages_->incoming.buffers[k].data();
      for (const unsigned int i : neighbours_[k].ghosts)
      {
        std::memcpy(static_cast<char *>(ghosts) + (i - first_ghost) * bytes_per_object, from, bytes_per_object);
        from += bytes_per_object;
      }
    }
  }

  void GhostExchange::sum(std::vector<double> &values, const unsigned int n_components) const
  {
    start(&Neighbour::ghosts, values.data(), 0, &Neighbour::owned, n_components * sizeof(double));
    finish_add(values.data(), n_components);
    update(values, n_components);
  }

  void GhostExchange::start_fetch(const double *const owned, const unsigned int n_components) const
  {
    start(&Neighbour::owned, owned, 0, &Neighbour::ghosts, n_components * sizeof(double));
  }

  void GhostExchange::finish_fetch(double *const ghosts, const unsigned int n_components) const
  {
    finish_copy(ghosts, n_owned_, n_components * sizeof(double));
  }

  void GhostExchange::fetch(const double *const owned, double *const ghosts, const unsigned int n_components) const
  {
    start_fetch(owned, n_components);
    finish_fetch(ghosts, n_components);
  }

  void GhostExchange::start_add(const double *const ghosts, const unsigned int n_components) const
  {
    start(&Neighbour::ghosts, ghosts, n_owned_, &Neighbour::owned, n_components * sizeof(double));
  }

  void GhostExchange::finish_add(double *const owned, const unsigned int n_components) const
  {
    if (neighbours_.empty())
      return;
    messages_->incoming.complete();
    for (std::size_t k = 0; k < neighbours_.size(); ++k)
    {
      const char *from = messages_->incoming.buffers[k].data();
      for (const unsigned int i : neighbours_[k].owned)
        for (unsigned int c = 0; c < n_components; ++c)
        {
          double part;
          std::memcpy(&part, from, sizeof(double));
          owned[std::size_t(i) * n_components + c] += part;
          from += sizeof(double);
        }
    }
  }

  void GhostExchange::add(const double *const ghosts, double *const owned, const unsigned int n_components) const
  {
    start_add(ghosts, n_components);
    finish_add(owned, n_components);
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
    const auto                       incoming = sparse_exchange(communicator_, outgoing);
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
