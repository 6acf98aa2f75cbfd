#ifndef nodus_output_vtu_fields_h
#define nodus_output_vtu_fields_h

#include "bulk/nodal_stress.h"
#include "bulk/principal_axes.h"
#include "output/vtu_grid.h"
#include "parameters/output_fields.h"
#include <nodus/contact/contact_fields.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Nodus
{
  /// A node of a body.
  struct BodyNode
  {
    explicit BodyNode(const StressAndStrain &values)
        : values(values)
    {
    }
    /// Principal Cauchy stresses, the largest one first, and their directions.
    const std::array<PrincipalAxis, dim> &principal() const
    {
      if (!principal_)
        principal_ = principal_axes(values.cauchy_stress);
      return *principal_;
    }

    const StressAndStrain &values;

  private:
    mutable std::optional<std::array<PrincipalAxis, dim>> principal_;
  };

  /// A slave node of a contact pair.
  struct ContactNode
  {
    const ContactFields &fields;
    unsigned int         k; ///< its place there
  };

  /// An array of a VTU file and what it has at a node.
  template <typename Node>
  struct VtuField
  {
    const char  *name;
    unsigned int components;
    void (*write)(const Node &node, VtuGrid::Array &array);
  };

  /// Those of OutputParameters::fields; the names are those of output_fields(). @p plastic: some body has an
  /// equivalent plastic strain.
  std::vector<VtuField<BodyNode>>    chosen_body_fields(const std::vector<std::string> &fields, bool plastic);
  std::vector<VtuField<ContactNode>> chosen_contact_fields(const std::vector<std::string> &fields);
} // namespace Nodus

#endif
