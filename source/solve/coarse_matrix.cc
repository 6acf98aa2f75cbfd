#include <nodus/solve/coarse_matrix.h>
#include <nodus/solve/saddle_point_operator.h>

#include <deal.II/base/mpi.h>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int n_modes = CoarseRow::n_modes;

    /// Hands the rows behind the owned ones to their owners.
    void gather(std::vector<CoarseRow>      &rows,
                const DoFIndex               first,
                const std::vector<DoFIndex> &ghosts,
                const Epetra_Map            &map,
                const MPI_Comm               communicator)
    {
      const unsigned int       n_owned = rows.size() - ghosts.size();
      std::vector<MatrixEntry> entries;
      for (unsigned int g = 0; g < ghosts.size(); ++g)
        rows[n_owned + g].for_each(
            [&](const DoFIndex column, const CoarseRow::Block &block)
            {
              for (unsigned int k = 0; k < n_modes * n_modes; ++k)
                entries.push_back({n_modes * ghosts[g] + k / n_modes, n_modes * column + k % n_modes, block[k]});
            });
      rows.resize(n_owned);
      dealii::IndexSet owned(map.NumGlobalElements());
      owned.add_range(n_modes * first, n_modes * (first + n_owned));
      for (const MatrixEntry &e : Ownership(owned, communicator).exchange(std::move(entries)))
        rows[e.row / n_modes - first][e.column / n_modes][n_modes * (e.row % n_modes) + e.column % n_modes] += e.value;
    }
  } // namespace

  std::unique_ptr<Epetra_CrsMatrix> make_coarse_matrix(std::vector<CoarseRow>       rows,
                                                       const DoFIndex               first,
                                                       const std::vector<DoFIndex> &ghosts,
                                                       const Epetra_Map            &map,
                                                       const MPI_Comm               communicator)
  {
    if (dealii::Utilities::MPI::max(ghosts.empty() ? 0 : 1, communicator) != 0)
      gather(rows, first, ghosts, map, communicator);

    double           largest = 0.;
    std::vector<int> length(std::max(1, map.NumMyElements()), 0);
    for (unsigned int a = 0; a < rows.size(); ++a)
    {
      const CoarseRow::Block &diagonal = rows[a][first + a];
      unsigned int            n_blocks = 0;
      rows[a].for_each([&](const DoFIndex, const CoarseRow::Block &) { ++n_blocks; });
      for (unsigned int m = 0; m < n_modes; ++m)
      {
        largest                 = std::max(largest, std::abs(diagonal[(n_modes + 1) * m]));
        length[n_modes * a + m] = n_modes * n_blocks;
      }
    }
    largest = dealii::Utilities::MPI::max(largest, communicator);

    auto                matrix = std::make_unique<Epetra_CrsMatrix>(Copy, map, length.data(), true);
    std::vector<int>    columns;
    std::vector<double> values;
    for (unsigned int a = 0; a < rows.size(); ++a)
    {
      CoarseRow::Block &diagonal = rows[a][first + a];
      for (unsigned int m = 0; m < n_modes; ++m)
        if (diagonal[(n_modes + 1) * m] == 0.)
          diagonal[(n_modes + 1) * m] = largest > 0. ? largest : 1.;
      for (unsigned int m = 0; m < n_modes; ++m)
      {
        columns.clear();
        values.clear();
        rows[a].for_each(
            [&](const DoFIndex column, const CoarseRow::Block &block)
            {
              for (unsigned int o = 0; o < n_modes; ++o)
              {
                columns.push_back(n_modes * column + o);
                values.push_back(block[n_modes * m + o]);
              }
            });
        matrix->InsertGlobalValues(
            static_cast<int>(n_modes * (first + a) + m), columns.size(), values.data(), columns.data());
      }
      rows[a] = CoarseRow();
    }
    matrix->FillComplete(map, map);
    return matrix;
  }
} // namespace Nodus
