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

    struct Rows
    {
      std::string contact, reactions; ///< with the headers
    };
    const Rows &rows() const
    {
      return rows_;
    }
    /// Writes the tables as they were when they had these @p rows. Collective. @throws InputError as the constructor.
    void continue_from(const Rows &rows);

  private:
    void write() const;

    std::string folder_;
    MPI_Comm    communicator_;
    Rows        rows_;
  };
} // namespace Nodus

#endif
