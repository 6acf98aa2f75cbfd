#ifndef nodus_output_tables_h
#define nodus_output_tables_h

#include <nodus/output/contact_fields.h>
#include <nodus/types.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Nodus
{
  /// contact.csv (one row per increment and pair) and reactions.csv (one row per increment and displacement condition),
  /// rewritten as a whole after each increment (temporary name, then rename) by rank 0.
  class Tables
  {
  public:
    /// Collective. @throws InputError when the folder cannot be created or written.
    Tables(const std::string &folder, MPI_Comm communicator);

    struct Reaction
    {
      std::string name;
      Vector3     force; ///< of the ground on the bodies
    };

    /// All arguments are global values, the same on every rank. Collective. @throws InputError as the constructor.
    void add(unsigned int                          increment,
             double                                t,
             const std::vector<ContactResultants> &contact,
             const std::vector<Reaction>          &reactions,
             const IterationCounts                &counts);

  private:
    std::string folder_;
    MPI_Comm    communicator_;
    std::string contact_rows_, reaction_rows_;
  };
} // namespace Nodus

#endif
