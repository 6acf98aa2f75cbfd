#ifndef nodus_output_vtu_grid_h
#define nodus_output_vtu_grid_h

#include <nodus/base/types.h>

#include <deal.II/base/symmetric_tensor.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace Nodus
{
  /// Hexahedra or quadrilaterals of degree 1 or 2 with values at their nodes and cells: a piece of an unstructured grid
  /// of VTK. deal.II writes the nodes of each cell anew, and no values of cells.
  class VtuGrid
  {
  public:
    /// Values of all nodes or of all cells, one after the other; 1 (scalar), 3 (vector) or 9 (tensor, by rows) to each.
    class Array
    {
    public:
      Array(const std::string &name, const unsigned int components)
          : name(name)
          , components(components)
      {
      }
      Array &operator<<(const double value)
      {
        values.push_back(static_cast<float>(value));
        return *this;
      }
      Array &operator<<(const dealii::Tensor<1, dim> &v)
      {
        return *this << v[0] << v[1] << v[2];
      }
      Array &operator<<(const dealii::SymmetricTensor<2, dim> &T)
      {
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            *this << T[i][j];
        return *this;
      }

      std::string        name;
      unsigned int       components;
      std::vector<float> values;
    };

    /// @p cell_dim: 3 (hexahedra) or 2 (quadrilaterals). @p deformed: whether points are where they are at time @p t,
    /// which the file says.
    VtuGrid(unsigned int cell_dim, unsigned int degree, double t, bool deformed);

    Array                     points = {"Points", dim};
    std::vector<Array>        point_data, cell_data;
    std::vector<std::int32_t> nodes;              ///< of the cells, (degree+1)^cell_dim each, lexicographic
    std::vector<std::int32_t> node_ids, cell_ids; ///< whole numbers; cells of 2D have none

    std::size_t n_points() const
    {
      return points.values.size() / dim;
    }
    std::size_t n_cells() const
    {
      return nodes.size() / order_.size();
    }

    void write(std::ostream &out) const;
    /// The file that makes one grid of the @p pieces of all ranks (.pvtu).
    void write_record(std::ostream &out, const std::vector<std::string> &pieces) const;

  private:
    template <typename WriteArray>
    void write_data(std::ostream &out, const std::string &prefix, const WriteArray &array) const;

    unsigned int              cell_dim_;
    std::uint8_t              type_;  ///< of the cells in VTK
    std::vector<unsigned int> order_; ///< place in `nodes` of each node of a cell of VTK
    double                    t_;
    bool                      deformed_;
  };
} // namespace Nodus

#endif
