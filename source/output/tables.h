#ifndef nodus_output_tables_h
#define nodus_output_tables_h

#include "output/energies.h"
#include "output/verdict.h"
#include "solve/newton.h"
#include <nodus/base/types.h>
#include <nodus/contact/contact_fields.h>

#include <deal.II/base/symmetric_tensor.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Nodus
{
  /// contact.csv (one row per increment and pair), masters.csv (one row per increment and body of pairs with several
  /// master bodies, if there are any), reactions.csv (one row per increment and displacement condition),
  /// rigid_bodies.csv (one row per increment and rigid body with free components, if there are any), energy.csv (one
  /// row per increment), points.csv and lines.csv (one row per point that is asked for) and convergence.csv (one row
  /// per Newton iteration), rewritten as a whole after each increment (temporary name, then rename) by rank 0.
  class Tables
  {
  public:
    /// @p bodies: their names. Collective. @throws InputError when the folder cannot be created or written.
    Tables(const std::string &folder, MPI_Comm communicator, const std::vector<std::string> &bodies);

    struct Reaction
    {
      std::string name;
      Vector3     force; ///< of the ground on the bodies
    };

    /// What a body has at a point.
    struct PointRow
    {
      std::string                     name;     ///< of the point or line
      double                          distance; ///< along the line [length]
      Vector3                         displacement;
      dealii::SymmetricTensor<2, dim> cauchy_stress;
    };
    /// Rows of points.csv or lines.csv, which the next add() writes. Global values, the same on every rank.
    void add_points(unsigned int increment, double t, const std::vector<PointRow> &points);
    void add_lines(unsigned int increment, double t, const std::vector<PointRow> &points);

    /// All arguments are global values, the same on every rank. Collective. @throws InputError as the constructor.
    void add(unsigned int                          increment,
             double                                t,
             const std::vector<ContactResultants> &contact,
             const std::vector<Reaction>          &reactions,
             const std::vector<RigidBodyMotion>   &rigid_bodies,
             const std::vector<PreloadSection>    &preloads,
             const Energies                       &energies,
             const IterationCounts                &counts,
             const Verdict                        &verdict);

    /// One iterate of Newton's method, kept until the next add() or add_failure().
    struct Iteration
    {
      unsigned int         increment;
      double               t;
      IterationCounts      pass;      ///< numbers of the geometry, threshold and status pass; fallbacks so far
      unsigned int         iteration; ///< 0: before the first correction
      NewtonProblem::Norms norms;
      unsigned int         krylov; ///< iterations of the correction that led here
    };
    void add(const Iteration &iteration);
    /// Statuses that the status loop changed after the last iterate.
    void add_status_changes(unsigned int n);

    /// Writes the iterations of an increment that did not converge. Collective. @throws InputError as the constructor.
    void add_failure();

    struct Rows
    {
      std::string contact, reactions, energies, iterations; ///< with the headers
      std::string masters, rigid_bodies, points, lines;     ///< likewise, empty without any
      std::string preloads;
    };
    const Rows &rows() const
    {
      return rows_;
    }
    /// Writes the tables as they were when they had these @p rows. Collective. @throws InputError as the constructor.
    void continue_from(const Rows &rows);

  private:
    void write() const;
    void write(const std::string &name, const std::string &rows) const;
    void finish_iterations();

    std::string              folder_;
    MPI_Comm                 communicator_;
    std::vector<std::string> bodies_;
    std::vector<Iteration>   iterations_;
    Rows                     rows_;
  };
} // namespace Nodus

#endif
