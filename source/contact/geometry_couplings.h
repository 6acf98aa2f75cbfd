#ifndef nodus_contact_geometry_couplings_h
#define nodus_contact_geometry_couplings_h

#include "contact/contact_assembler.h"
#include "contact/face_variation.h"

#include <vector>

namespace Nodus
{
  /// What the geometry tangent couples, brought together row by row before it is written to the system: rows of surface
  /// nodes (forces) and of multipliers, columns of VariationSources.
  class GeometryCouplings
  {
  public:
    using Matrix = FaceVariation::Matrix;

    GeometryCouplings(const ContactSurfaces &surfaces, const VariationSources &sources);

    /// @p values: three columns for each of @p sources, and as many rows as the unknown has components.
    void add_force(unsigned int node, const std::vector<unsigned int> &sources, const Matrix &values)
    {
      add(forces_[node], sources, values);
    }
    void add_gap(unsigned int slave, const std::vector<unsigned int> &sources, const Matrix &values)
    {
      add(gaps_[slave], sources, values);
    }
    void add_friction(unsigned int slave, const std::vector<unsigned int> &sources, const Matrix &values)
    {
      add(frictions_[slave], sources, values);
    }

    /// Adds all to the variation of @p system, and what prescribed displacements add to its right-hand side.
    /// Collective.
    void write(const ContactState &state, LinearSystem &system);

  private:
    /// Sources and, for each of them, a block of values.
    struct Row
    {
      std::vector<unsigned int> sources;
      std::vector<double>       values;
    };
    class Writer;

    void add(Row &row, const std::vector<unsigned int> &sources, const Matrix &values);
    /// Replaces parts of offsets by the nodes that they depend on.
    void expand(Row &row);

    const ContactSurfaces    &surfaces_;
    const VariationSources   &sources_;
    std::vector<Row>          forces_, gaps_, frictions_;
    std::vector<unsigned int> place_; ///< of a source in the row at hand
    Row                       expanded_;
  };
} // namespace Nodus

#endif
