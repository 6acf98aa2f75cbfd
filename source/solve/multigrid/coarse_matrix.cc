#include "solve/multigrid/coarse_matrix.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int n_modes = CoarseRow::n_modes, n_parts = n_modes / dim;

    /// Adds blocks, as (row, column, block), that other ranks have for owned rows.
    void add_from_others(std::vector<CoarseRow>                            &rows,
                         const DoFIndex                                     first,
                         const std::map<unsigned int, std::vector<double>> &outgoing,
                         const MPI_Comm                                     communicator)
    {
      for (const auto &[rank, numbers] : sparse_exchange(communicator, outgoing))
        for (auto p = numbers.begin(); p != numbers.end();)
        {
          CoarseRow        &row   = rows[static_cast<DoFIndex>(*p++) - first];
          CoarseRow::Block &block = row[static_cast<DoFIndex>(*p++)];
          for (unsigned int k = 0; k < n_modes * n_modes; ++k)
            block[k] += *p++;
        }
    }

    unsigned int owner(const std::vector<DoFIndex> &starts, const DoFIndex aggregate)
    {
      return std::upper_bound(starts.begin(), starts.end(), aggregate) - starts.begin() - 1;
    }

    /// Hands the rows behind the owned ones to their owners.
    void gather(std::vector<CoarseRow>      &rows,
                const DoFIndex               first,
                const std::vector<DoFIndex> &starts,
                const std::vector<DoFIndex> &ghosts,
                const MPI_Comm               communicator)
    {
      const unsigned int                          n_owned = rows.size() - ghosts.size();
      std::map<unsigned int, std::vector<double>> outgoing; // row, column, block
      for (unsigned int g = 0; g < ghosts.size(); ++g)
      {
        std::vector<double> &numbers = outgoing[owner(starts, ghosts[g])];
        rows[n_owned + g].for_each(
            [&](const DoFIndex column, const CoarseRow::Block &block)
            {
              numbers.insert(numbers.end(), {static_cast<double>(ghosts[g]), static_cast<double>(column)});
              numbers.insert(numbers.end(), block.begin(), block.begin() + n_modes * n_modes);
            });
      }
      rows.resize(n_owned);
      add_from_others(rows, first, outgoing, communicator);
    }

    /// Gives the owners of columns above the own rows what they have below theirs.
    void mirror(std::vector<CoarseRow>      &rows,
                const DoFIndex               first,
                const std::vector<DoFIndex> &starts,
                const MPI_Comm               communicator)
    {
      std::map<unsigned int, std::vector<double>> outgoing;
      for (unsigned int a = 0; a < rows.size(); ++a)
        rows[a].for_each(
            [&](const DoFIndex column, const CoarseRow::Block &block)
            {
              if (column < first + rows.size())
                return;
              std::vector<double> &numbers = outgoing[owner(starts, column)];
              numbers.insert(numbers.end(), {static_cast<double>(column), static_cast<double>(first + a)});
              for (unsigned int m = 0; m < n_modes; ++m)
                for (unsigned int k = 0; k < n_modes; ++k)
                  numbers.push_back(block[n_modes * k + m]);
            });
      add_from_others(rows, first, outgoing, communicator);
    }

    void fill_diagonal(std::vector<CoarseRow> &rows, const DoFIndex first, const MPI_Comm communicator)
    {
      double largest = 0.;
      for (unsigned int a = 0; a < rows.size(); ++a)
        for (unsigned int m = 0; m < n_modes; ++m)
          largest = std::max(largest, std::abs(rows[a][first + a][(n_modes + 1) * m]));
      largest = dealii::Utilities::MPI::max(largest, communicator);
      for (unsigned int a = 0; a < rows.size(); ++a)
        for (unsigned int m = 0; m < n_modes; ++m)
          if (double &entry = rows[a][first + a][(n_modes + 1) * m]; entry == 0.)
            entry = largest > 0. ? largest : 1.;
    }

    /// Calls f(part of the row, part of the column, its first entry) for the 3x3 blocks that are not zero: corners of
    /// cells have neighbours that the other corner of their pair has not.
    template <typename Function>
    void for_parts(const CoarseRow::Block &block, const Function &f)
    {
      for (unsigned int part = 0; part < n_parts; ++part)
        for (unsigned int other = 0; other < n_parts; ++other)
        {
          const double *const entry = block.data() + n_modes * dim * part + dim * other;
          bool                zero  = true;
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              zero = zero && entry[n_modes * c + d] == 0.;
          if (!zero)
            f(part, other, entry);
        }
    }
  } // namespace

  std::unique_ptr<BlockCsrMatrix> make_coarse_matrix(std::vector<CoarseRow>       rows,
                                                     const std::vector<DoFIndex> &starts,
                                                     const std::vector<DoFIndex> &ghosts,
                                                     const MPI_Comm               communicator)
  {
    const unsigned int n_owned = rows.size() - ghosts.size();
    const DoFIndex     first   = starts[dealii::Utilities::MPI::this_mpi_process(communicator)];
    dealii::IndexSet   owned(n_modes * starts.back());
    owned.add_range(n_modes * first, n_modes * (first + n_owned));
    gather(rows, first, starts, ghosts, communicator);
    mirror(rows, first, starts, communicator);
    fill_diagonal(rows, first, communicator);

    std::vector<DoFIndex> ghost_nodes;
    for (const CoarseRow &row : rows)
      row.for_each(
          [&](const DoFIndex column, const CoarseRow::Block &)
          {
            if (column < first || column >= first + n_owned)
              for (unsigned int part = 0; part < n_parts; ++part)
                ghost_nodes.push_back(n_parts * column + part);
          });
    auto map = std::make_shared<const NodeMap>(owned, std::move(ghost_nodes), communicator);

    auto matrix = std::make_unique<BlockCsrMatrix>();
    matrix->reinit(map,
                   [&](const std::uint32_t i, std::vector<std::uint32_t> &columns)
                   {
                     rows[i / n_parts].for_each(
                         [&](const DoFIndex column, const CoarseRow::Block &block)
                         {
                           const unsigned int j = map->local(n_parts * column);
                           for_parts(block,
                                     [&](const unsigned int part, const unsigned int other, const double *)
                                     {
                                       if (part == i % n_parts && j + other > i)
                                         columns.push_back(j + other);
                                     });
                         });
                   });
    for (unsigned int a = 0; a < n_owned; ++a)
    {
      rows[a].for_each(
          [&](const DoFIndex column, const CoarseRow::Block &block)
          {
            const unsigned int j = map->local(n_parts * column);
            for_parts(block,
                      [&](const unsigned int part, const unsigned int other, const double *const entry)
                      {
                        if (j + other < n_parts * a + part)
                          return;
                        double *target = matrix->block(matrix->position(n_parts * a + part, j + other).block());
                        for (unsigned int c = 0; c < dim; ++c)
                          for (unsigned int d = 0; d < dim; ++d)
                            target[dim * c + d] = entry[n_modes * c + d];
                      });
          });
      rows[a] = CoarseRow(); // before the next ones are copied
    }
    return matrix;
  }
} // namespace Nodus
