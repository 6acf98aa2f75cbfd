#ifndef nodus_output_vtu_h
#define nodus_output_vtu_h

#include "bulk/solid_assembler.h"
#include "mesh/bodies.h"
#include <nodus/base/types.h>
#include <nodus/contact/contact_fields.h>
#include <nodus/parameters/solution_parameters.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Writes the bodies (bodies.pvd, bodies_0001.pvtu, ...) and the slave contact surfaces (contact.pvd, ...) of each
  /// written increment, on the configuration and with the fields that were chosen. Files appear complete or not at all
  /// (temporary name, then rename).
  class VtuOutput
  {
  public:
    /// @p by_increment: the series go by the number of the increment, where time goes back.
    VtuOutput(const OutputParameters        &parameters,
              const Bodies                  &bodies,
              const dealii::DoFHandler<dim> &dof_handler,
              const dealii::Mapping<dim>    &mapping,
              const SolidAssembler          &solid,
              bool                           by_increment);
    ~VtuOutput();

    /// @p u has ghost entries. Collective. @throws InputError when the folder cannot be written.
    void write(unsigned int increment, double t, const Vector &u, const std::vector<ContactFields> &contact);

    /// Values at the displacement nodes: a vector, or three scalars in the places of its components.
    struct NodalField
    {
      std::vector<std::string> names;  ///< one, or three
      Vector                   values; ///< with ghost entries
    };
    /// Writes the bodies at displacement @p u, in equilibrium or not, as <name>.vtu, or as <name>.pvtu and its pieces,
    /// out of the series. @p det_F: the smallest of each active cell. Collective. @throws InputError as write().
    void write_state(const std::string             &name,
                     double                         t,
                     const Vector                  &u,
                     const std::vector<NodalField> &fields,
                     const std::vector<float>      &det_F);
    /// The file to open then.
    std::string state_file(const std::string &name) const;

    /// (time or number, file) of what was written so far, by the name of the series.
    using Series = std::map<std::string, std::vector<std::pair<double, std::string>>>;
    const Series &series() const;
    /// Writes the time series as they were when they had these files. Collective. @throws InputError as write().
    void continue_from(const Series &series);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace Nodus

#endif
