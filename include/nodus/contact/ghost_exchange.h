#ifndef nodus_contact_ghost_exchange_h
#define nodus_contact_ghost_exchange_h

#include <nodus/types.h>

#include <mpi.h>

#include <type_traits>
#include <vector>

namespace Nodus
{
  /// Arrays with one entry per local object, where every object has one owner and ghosts on other ranks: copies the
  /// owners' values to the ghosts, or adds the ghosts' values to the owners'.
  class GhostExchange
  {
  public:
    GhostExchange() = default;
    /// @p key: number of each local object, the same on all ranks that have it; @p owner: its rank, which must have it.
    /// Collective.
    GhostExchange(const std::vector<DoFIndex> &key, const std::vector<unsigned int> &owner, MPI_Comm communicator);

    /// Ghosts get the values of their owners; @p values has @p n_components successive entries per object. Collective.
    template <typename T>
    void update(std::vector<T> &values, const unsigned int n_components = 1) const
    {
      static_assert(std::is_trivially_copyable<T>::value, "values are sent as bytes");
      copy(values.data(), n_components * sizeof(T));
    }

    /// Owners and ghosts get the sum over all ranks. Collective.
    void sum(std::vector<double> &values, unsigned int n_components = 1) const;

  private:
    struct Neighbour
    {
      unsigned int              rank;
      std::vector<unsigned int> owned, ghosts; ///< local objects that it has as ghosts, and that it owns
    };
    void copy(void *values, std::size_t bytes_per_object) const;

    MPI_Comm               communicator_ = MPI_COMM_SELF;
    std::vector<Neighbour> neighbours_;
  };
} // namespace Nodus

#endif
