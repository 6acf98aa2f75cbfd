#ifndef nodus_solve_mode_panel_h
#define nodus_solve_mode_panel_h

#include "solve/multigrid/coarse_matrix.h"

#include <cstring>
#include <vector>

/// Products of 3x3 blocks with what six modes do at a node, in vector registers; for the files of multigrid/.
namespace Nodus::ModePanel
{
  constexpr unsigned int n_modes = CoarseRow::n_modes;
  constexpr unsigned int none    = static_cast<unsigned int>(-1);

  // The six modes fill six lanes of a vector of eight; the others hold what comes next in memory, or zero.
  typedef double Lanes __attribute__((vector_size(64)));
  typedef float  Stored __attribute__((vector_size(32)));

  /// Three displacements by the six modes.
  struct Panel
  {
    Lanes row[dim];
  };

  inline void clear_unused_lanes(Panel &panel)
  {
    for (Lanes &row : panel.row)
      for (unsigned int lane = n_modes; lane < 8; ++lane)
        row[lane] = 0.;
  }

  inline Panel load(const float *block)
  {
    Panel panel;
    for (unsigned int c = 0; c < dim; ++c)
    {
      Stored stored;
      std::memcpy(&stored, block + n_modes * c, sizeof(Stored));
      panel.row[c] = __builtin_convertvector(stored, Lanes);
    }
    return panel;
  }

  /// c += a p
  inline void add_product(const double *a, const bool transposed, const Panel &p, Panel &c)
  {
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int k = 0; k < dim; ++k)
        c.row[i] += (transposed ? a[dim * k + i] : a[dim * i + k]) * p.row[k];
  }

  inline double at(const float *const block, const unsigned int c, const unsigned int m)
  {
    return block[n_modes * c + m];
  }
  inline double at(const Panel *const panel, const unsigned int c, const unsigned int m)
  {
    return panel->row[c][m];
  }

  /// sum += block^T p, where the unused lanes of p are zero; the block is a Panel or stored.
  template <typename Block>
  void add_transposed_product(const Block *const block, const Panel &p, CoarseRow::Block &sum)
  {
    Lanes row[n_modes];
    for (unsigned int m = 0; m < n_modes; ++m)
      std::memcpy(&row[m], sum.data() + n_modes * m, sizeof(Lanes));
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int m = 0; m < n_modes; ++m)
        row[m] += at(block, c, m) * p.row[c];
    for (unsigned int m = 0; m < n_modes; ++m) // in this order: each store repairs what the one before spilt over
      std::memcpy(sum.data() + n_modes * m, &row[m], sizeof(Lanes));
  }

  /// What the six modes do, without spare lanes.
  struct Modes
  {
    typedef double Four __attribute__((vector_size(32)));
    typedef double Two __attribute__((vector_size(16)));
    Four           first;
    Two            last;

    static Modes load(const double *values)
    {
      Modes modes;
      std::memcpy(&modes.first, values, sizeof(Four));
      std::memcpy(&modes.last, values + 4, sizeof(Two));
      return modes;
    }
    static Modes load(const float *values)
    {
      typedef float StoredFour __attribute__((vector_size(16)));
      typedef float StoredTwo __attribute__((vector_size(8)));
      StoredFour    first;
      StoredTwo     last;
      std::memcpy(&first, values, sizeof(first));
      std::memcpy(&last, values + 4, sizeof(last));
      return {__builtin_convertvector(first, Four), __builtin_convertvector(last, Two)};
    }
    void store(double *values) const
    {
      std::memcpy(values, &first, sizeof(Four));
      std::memcpy(values + 4, &last, sizeof(Two));
    }
    /// Adds a times b, for each mode or the same for all.
    void add_product(const Modes &a, const Modes &b)
    {
      first += a.first * b.first;
      last += a.last * b.last;
    }
    void add_product(const Modes &a, const double b)
    {
      first += a.first * b;
      last += a.last * b;
    }
    double sum() const
    {
      return (first[0] + first[1]) + (first[2] + first[3]) + (last[0] + last[1]);
    }
  };

  /// Sum of panels by column, for one row at a time.
  class SparseRow
  {
  public:
    void reinit(const unsigned int n_columns)
    {
      slot_.assign(n_columns, none);
      columns_.clear();
    }
    Panel &operator[](const unsigned int column)
    {
      if (slot_[column] == none)
      {
        slot_[column] = columns_.size();
        columns_.push_back(column);
        if (panels_.size() < columns_.size())
          panels_.emplace_back();
        panels_[slot_[column]] = Panel{};
      }
      return panels_[slot_[column]];
    }
    const std::vector<unsigned int> &columns() const
    {
      return columns_;
    }
    /// Of the k-th column, with unused lanes of zero.
    const Panel &panel(const unsigned int k)
    {
      clear_unused_lanes(panels_[k]);
      return panels_[k];
    }
    void clear()
    {
      for (const unsigned int column : columns_)
        slot_[column] = none;
      columns_.clear();
    }

  private:
    std::vector<unsigned int> slot_, columns_;
    std::vector<Panel>        panels_;
  };
} // namespace Nodus::ModePanel

#endif
