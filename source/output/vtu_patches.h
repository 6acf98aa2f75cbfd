#ifndef nodus_output_vtu_patches_h
#define nodus_output_vtu_patches_h

#include "base/deal_ii_versions.h"
#include <nodus/base/types.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/table.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/reference_cell.h>

#include <string>
#include <tuple>
#include <vector>

namespace Nodus
{
  /// Rows of a patch's data table, in groups of 1 (scalar), 3 (vector) or 9 (tensor).
  struct PatchField
  {
    std::string  name;
    unsigned int components;
  };

  /// Cells or faces with values at their nodes. Both are filled by hand: the nodes of the deformed configuration
  /// are then exactly where the solution has them, and stresses and contact fields stay nodal values. deal.II has no
  /// reader-ready output of a field that lives on a part of the boundary only.
  template <int patch_dim>
  class PatchOutput : public dealii::DataOutInterface<patch_dim, dim>
  {
  public:
    using Patch = dealii::DataOutBase::Patch<patch_dim, dim>;

    PatchOutput(const std::vector<PatchField> &fields, const unsigned int degree, const double t)
    {
      using namespace dealii::DataComponentInterpretation;
      for (const auto &field : fields)
      {
        const unsigned int first = names_.size();
        for (unsigned int c = 0; c < field.components; ++c)
          names_.push_back(field.components == 1 ? field.name : field.name + '_' + std::to_string(c));
        if (field.components > 1)
          ranges_.emplace_back(first,
                               first + field.components - 1,
                               field.name,
                               field.components == dim ? component_is_part_of_vector : component_is_part_of_tensor);
      }
      dealii::DataOutBase::VtkFlags flags;
      flags.time                     = t;
      flags.print_date_and_time      = false; // equal runs give equal files
      flags.write_higher_order_cells = degree > 1;
      flags.compression_level        = fastest_compression;
      this->set_flags(flags);
    }

    unsigned int n_values() const
    {
      return names_.size();
    }

    /// A patch of the given degree; the last three rows of its data are the coordinates of the nodes.
    Patch &add_patch(const unsigned int degree)
    {
      patches_.emplace_back();
      Patch &patch               = patches_.back();
      patch.patch_index          = patches_.size() - 1;
      patch.n_subdivisions       = degree;
      patch.reference_cell       = dealii::ReferenceCells::get_hypercube<patch_dim>();
      patch.points_are_available = true;
      patch.data.reinit(n_values() + dim, dealii::Utilities::fixed_power<patch_dim>(degree + 1));
      return patch;
    }

  private:
    const std::vector<Patch> &get_patches() const override
    {
      return patches_;
    }
    std::vector<std::string> get_dataset_names() const override
    {
      return names_;
    }
    std::vector<std::tuple<unsigned int,
                           unsigned int,
                           std::string,
                           dealii::DataComponentInterpretation::DataComponentInterpretation>>
    get_nonscalar_data_ranges() const override
    {
      return ranges_;
    }

    std::vector<Patch>       patches_;
    std::vector<std::string> names_;
    std::vector<std::tuple<unsigned int,
                           unsigned int,
                           std::string,
                           dealii::DataComponentInterpretation::DataComponentInterpretation>>
        ranges_;
  };

  /// Fills one column of a patch's data table row by row, in the order of the fields.
  class PatchColumn
  {
  public:
    PatchColumn(dealii::Table<2, float> &data, const unsigned int column)
        : data_(data)
        , column_(column)
    {
    }
    PatchColumn &operator<<(const double value)
    {
      data_(row_++, column_) = value;
      return *this;
    }
    PatchColumn &operator<<(const dealii::Tensor<1, dim> &v)
    {
      return *this << v[0] << v[1] << v[2];
    }
    PatchColumn &operator<<(const dealii::SymmetricTensor<2, dim> &T)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          *this << T[i][j];
      return *this;
    }

  private:
    dealii::Table<2, float> &data_;
    unsigned int             column_, row_ = 0;
  };
} // namespace Nodus

#endif
