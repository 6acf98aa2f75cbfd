#include "contact/geometry_couplings.h"
#include "parallel/owned_values.h"
#include "parallel/wait_for_all.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;
  }

  GeometryCouplings::GeometryCouplings(const ContactSurfaces &surfaces, const VariationSources &sources)
      : surfaces_(surfaces)
      , sources_(sources)
      , forces_(surfaces.nodes().size())
      , gaps_(surfaces.slave_nodes().size())
      , frictions_(surfaces.slave_nodes().size())
      , place_(sources.size(), none)
  {
  }

  void GeometryCouplings::add(Row &row, const std::vector<unsigned int> &sources, const Matrix &values)
  {
    const unsigned int height = values.rows(), size = dim * height;
    for (unsigned int i = 0; i < row.sources.size(); ++i)
      place_[row.sources[i]] = i;
    for (unsigned int j = 0; j < sources.size(); ++j)
    {
      const auto block = values.middleCols<dim>(dim * j);
      if (block.isZero(0.))
        continue;
      unsigned int &place = place_[sources[j]];
      if (place == none)
      {
        place = row.sources.size();
        row.sources.push_back(sources[j]);
        row.values.resize(row.values.size() + size, 0.);
      }
      double *value = row.values.data() + size * place;
      for (unsigned int i = 0; i < height; ++i)
        for (unsigned int c = 0; c < dim; ++c)
          *value++ += block(i, c);
    }
    for (const unsigned int source : row.sources)
      place_[source] = none;
  }

  void GeometryCouplings::expand(Row &row)
  {
    if (row.sources.empty())
      return;
    const unsigned int size = row.values.size() / row.sources.size();
    expanded_.sources.clear();
    expanded_.values.clear();
    const auto at = [&](const unsigned int node)
    {
      unsigned int &place = place_[node];
      if (place == none)
      {
        place = expanded_.sources.size();
        expanded_.sources.push_back(node);
        expanded_.values.resize(expanded_.values.size() + size, 0.);
      }
      return expanded_.values.data() + size * place;
    };
    for (unsigned int i = 0; i < row.sources.size(); ++i)
    {
      const double *const value = row.values.data() + size * i;
      if (sources_.is_node(row.sources[i]))
      {
        double *const sum = at(row.sources[i]);
        for (unsigned int k = 0; k < size; ++k)
          sum[k] += value[k];
        continue;
      }
      for (const NodeDerivative &d : sources_.derivative(row.sources[i]))
      {
        double *const sum = at(d.node);
        for (unsigned int k = 0; k < size; k += dim)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int j = 0; j < dim; ++j)
              sum[k + j] += value[k + c] * d.value[c][j];
      }
    }
    for (const unsigned int node : expanded_.sources)
      place_[node] = none;
    row.sources.swap(expanded_.sources);
    row.values.swap(expanded_.values);
  }

  class GeometryCouplings::Writer
  {
  public:
    Writer(const ContactSurfaces &surfaces, const ContactState &state, LinearSystem &system)
        : surfaces_(surfaces)
        , layout_(surfaces.layout())
        , state_(state)
        , system_(system)
        , forces_(surfaces.nodes().size())
        , multipliers_(3 * surfaces.slave_nodes().size(), 0.)
    {
    }

    /// @p value: 3 x 3, row by row; free nodes.
    void add_force(const unsigned int row, const unsigned int column, const double part, const double *const value)
    {
      for (unsigned int i = 0; i < dim; ++i)
        surfaces_.for_each_unknown(row,
                                   i,
                                   state_.x[row],
                                   state_.centre,
                                   [&](const DoFIndex row_index, const double row_part)
                                   {
                                     add_row(row_index,
                                             column,
                                             row_part * part,
                                             value + dim * i,
                                             [&](const double missing)
                                             {
                                               if (is_inner(row_index))
                                                 forces_[row][i] -= missing;
                                               else
                                                 system_.border_rhs[row_index - layout_.size()] -= missing;
                                             });
                                   });
    }
    /// A row of a slave node: its contact law (0) or friction law (1, 2).
    void add_law(const unsigned int  slave,
                 const unsigned int  law,
                 const unsigned int  column,
                 const double        part,
                 const double *const value)
    {
      const DoFIndex multiplier = surfaces_.multiplier(slave);
      add_row(law == 0 ? layout_.lambda(multiplier) : layout_.Lambda(multiplier, law - 1),
              column,
              part,
              value,
              [&](const double missing) { multipliers_[3 * slave + law] -= missing; });
    }

    /// Collective.
    void finish()
    {
      wait_for_all(layout_.communicator);
      surfaces_.add(forces_, system_.rhs.block(0));
      surfaces_.slave_exchange().sum(multipliers_, 3);
      const OwnedValues normal(system_.rhs.block(1)), tangential(system_.rhs.block(2));
      for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
      {
        const DoFIndex multiplier = surfaces_.multiplier(k);
        normal(multiplier) += multipliers_[3 * k];
        for (unsigned int i = 0; i < 2; ++i)
          tangential(2 * multiplier + i) += multipliers_[3 * k + 1 + i];
      }
      system_.symmetric = false;
    }

  private:
    bool is_inner(const DoFIndex index) const
    {
      return index < layout_.size();
    }
    /// @p missing(value): what a prescribed component of the column adds to the right-hand side, with the other sign.
    template <typename Missing>
    void add_row(const DoFIndex      row,
                 const unsigned int  column,
                 const double        part,
                 const double *const value,
                 const Missing      &missing)
    {
      for (unsigned int j = 0; j < dim; ++j)
      {
        if (surfaces_.fixed(column, j) && surfaces_.rigid_body(column) == none)
          missing(part * value[j] * state_.prescribed[column][j]);
        if (value[j] != 0.)
          surfaces_.for_each_unknown(column,
                                     j,
                                     state_.x[column],
                                     state_.centre,
                                     [&](const DoFIndex index, const double column_part)
                                     {
                                       (is_inner(row) && is_inner(index) ? system_.variation : system_.border)
                                           .add(row, index, part * column_part * value[j]);
                                     });
      }
    }

    const ContactSurfaces &surfaces_;
    const BlockLayout     &layout_;
    const ContactState    &state_;
    LinearSystem          &system_;
    std::vector<Vector3>   forces_;      ///< for the right-hand side, per surface node
    std::vector<double>    multipliers_; ///< likewise, three per slave node
  };

  void GeometryCouplings::write(const ContactState &state, LinearSystem &system)
  {
    std::size_t n = system.variation.row.size();
    for (auto *const rows : {&forces_, &gaps_, &frictions_})
      for (Row &row : *rows)
      {
        expand(row);
        n += row.values.size();
      }
    system.variation.reserve(n);
    Writer     writer(surfaces_, state, system);
    const auto for_each = [&](const std::vector<Row> &rows, const auto &f)
    {
      for (unsigned int r = 0; r < rows.size(); ++r)
        for (unsigned int i = 0; i < rows[r].sources.size(); ++i)
          surfaces_.expand(
              rows[r].sources[i],
              1.,
              [&](const unsigned int column, const double part)
              { f(r, column, part, rows[r].values.data() + rows[r].values.size() / rows[r].sources.size() * i); });
    };
    for_each(forces_,
             [&](const unsigned int r, const unsigned int column, const double part, const double *const value)
             { writer.add_force(r, column, part, value); });
    for_each(gaps_,
             [&](const unsigned int r, const unsigned int column, const double part, const double *const value)
             { writer.add_law(r, 0, column, part, value); });
    for_each(frictions_,
             [&](const unsigned int r, const unsigned int column, const double part, const double *const value)
             {
               writer.add_law(r, 1, column, part, value);
               writer.add_law(r, 2, column, part, value + dim);
             });
    writer.finish();
  }
} // namespace Nodus
