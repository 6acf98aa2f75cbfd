#ifndef nodus_mesh_region_h
#define nodus_mesh_region_h

#include "mesh/bodies.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <memory>

namespace dealii
{
  template <int>
  class FunctionParser;
}

namespace Nodus
{
  /// A part of the boundary of some or all bodies: faces by boundary id, thinned by a predicate of the
  /// reference coordinates (evaluated at the nodes for nodal conditions, at face centres for the others).
  class Region
  {
  public:
    /// @p context names the subsection in messages, e.g. "Contact pair 1, slave".
    /// @throws InputError, on every rank, on an unknown body, an id no face of the bodies has, a body without any of
    /// the ids, or a predicate that does not parse, or is not a number at a vertex or the centre of a face (without
    /// ids: cell) that it thins out. Collective.
    Region(const RegionParameters &parameters, const Bodies &bodies, const std::string &context);
    ~Region();
    Region(Region &&) noexcept;

    /// True when @p face of @p cell is at the boundary, of the region's body and has one of its ids.
    template <typename Cell>
    bool contains_face(const Cell &cell, const unsigned int face) const
    {
      return cell->face(face)->at_boundary() &&
             parameters_.takes(cell->material_id() + 1, cell->face(face)->boundary_id());
    }

    /// True when the body of the cell belongs to the region (body forces).
    template <typename Cell>
    bool contains_cell(const Cell &cell) const
    {
      return parameters_.has_body(cell->material_id() + 1);
    }

    /// contains_face, and the predicate holds at the centre of the face as @p mapping bends it.
    template <typename Cell>
    bool selects_face(const dealii::Mapping<dim> &mapping, const Cell &cell, const unsigned int face) const
    {
      if (!predicate_ || !contains_face(cell, face))
        return contains_face(cell, face);
      Point unit(0.5, 0.5, 0.5);
      unit[face / 2] = face % 2;
      return contains_point(mapping.transform_unit_to_real_cell(cell, unit));
    }

    /// contains_cell, and the predicate holds at the centre of the cell as @p mapping bends it.
    template <typename Cell>
    bool selects_cell(const dealii::Mapping<dim> &mapping, const Cell &cell) const
    {
      return contains_cell(cell) &&
             (!predicate_ || contains_point(mapping.transform_unit_to_real_cell(cell, Point(0.5, 0.5, 0.5))));
    }

    /// The predicate at a reference point; true where there is none.
    bool contains_point(const Point &X) const;

  private:
    void refuse_absent(const Bodies &bodies, const std::string &context) const;
    void refuse_undefined(const Bodies &bodies, const std::string &context) const;

    RegionParameters                             parameters_;
    std::unique_ptr<dealii::FunctionParser<dim>> predicate_;
  };
} // namespace Nodus

#endif
