#ifndef nodus_parallel_ghost_exchange_h
#define nodus_parallel_ghost_exchange_h

#include <nodus/base/types.h>

#include <mpi.h>

#include <functional>
#include <map>
#include <memory>
#include <type_traits>
#include <vector>

namespace Nodus
{
  /// Arrays with one entry per local object, where every object has one owner and ghosts on other ranks: copies the
  /// owners' values to the ghosts, or adds the ghosts' values to the owners'. A rank waits for its neighbours alone,
  /// and not for them to take what it has sent: deal.II's Partitioner does, and a rank that is ahead would lose its
  /// lead.
  class GhostExchange
  {
  public:
    GhostExchange();
    GhostExchange(GhostExchange &&) noexcept;
    GhostExchange &operator=(GhostExchange &&) noexcept;
    ~GhostExchange();
    /// @p key: number of each local object, the same on all ranks that have it; @p owner: its rank, which must have it.
    /// Collective.
    GhostExchange(const std::vector<DoFIndex> &key, const std::vector<unsigned int> &owner, MPI_Comm communicator);
    /// Objects that are numbered through from rank to rank: those of rank r begin at @p start[r], and @p start ends
    /// with the number of all. Locally the owned ones come first and then @p ghosts. Collective.
    static GhostExchange
    numbered_through(const std::vector<DoFIndex> &start, const std::vector<DoFIndex> &ghosts, MPI_Comm communicator);

    /// Ghosts get the values of their owners; @p values has @p n_components successive entries per object. Collective.
    template <typename T>
    void update(std::vector<T> &values, const unsigned int n_components = 1) const
    {
      static_assert(std::is_trivially_copyable<T>::value, "values are sent as bytes");
      start(&Neighbour::owned, values.data(), 0, &Neighbour::ghosts, n_components * sizeof(T));
      finish_copy(values.data(), 0, n_components * sizeof(T));
    }

    /// Owners and ghosts get the sum over all ranks. Collective.
    void sum(std::vector<double> &values, unsigned int n_components = 1) const;

    /// update() where ghosts have an array of their own, behind objects that are numbered through. Collective.
    void fetch(const double *owned, double *ghosts, unsigned int n_components = 1) const;
    /// Adds the values of ghosts to those of their owners, arrays as in fetch(). Collective.
    void add(const double *ghosts, double *owned, unsigned int n_components = 1) const;
    /// The same in two steps, between which there may be work that needs no ghosts, but no other exchange of this
    /// object. Collective.
    void start_fetch(const double *owned, unsigned int n_components = 1) const;
    void finish_fetch(double *ghosts, unsigned int n_components = 1) const;
    void start_add(const double *ghosts, unsigned int n_components = 1) const;
    void finish_add(double *owned, unsigned int n_components = 1) const;

    /// Numbers, as many as there are, for each ghost from its owner, objects numbered through: @p append adds those of
    /// an owned object to the end. Collective.
    std::vector<std::vector<double>>
    fetch_lists(const std::function<void(unsigned int owned, std::vector<double> &)> &append) const;

  private:
    using Keys = std::map<unsigned int, std::vector<DoFIndex>>;
    struct Neighbour
    {
      unsigned int              rank;
      std::vector<unsigned int> owned, ghosts; ///< local objects that it has as ghosts, and that it owns
    };
    using Objects = std::vector<unsigned int> Neighbour::*;
    struct Messages;

    /// @p ghosts by owner, in the order of @p wanted; @p find: the owned object of a key. Collective.
    void connect(const Keys                                       &wanted,
                 std::map<unsigned int, std::vector<unsigned int>> ghosts,
                 const std::function<unsigned int(DoFIndex)>      &find);
    /// Sends the values of @p from, the first of which is number @p first, and is ready to receive those of @p to.
    void start(Objects from, const void *values, unsigned int first, Objects to, std::size_t bytes_per_object) const;
    void finish_copy(void *ghosts, unsigned int first_ghost, std::size_t bytes_per_object) const;

    MPI_Comm                  communicator_ = MPI_COMM_SELF;
    unsigned int              n_owned_      = 0; ///< of objects that are numbered through
    std::vector<Neighbour>    neighbours_;       ///< by rank, so that a run repeats to the last digit
    std::unique_ptr<Messages> messages_;
  };
} // namespace Nodus

#endif
