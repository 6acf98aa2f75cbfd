#include "solve/trilinos/assemble.h"
#include "parallel/sparse_exchange.h"
#include "solve/node_block.h"

#include <Eigen/Core>

#include <algorithm>
#include <map>
#include <utility>

namespace Nodus
{
  namespace
  {
    using Block    = Eigen::Matrix<double, dim, dim, Eigen::RowMajor>;
    using BlockMap = Eigen::Map<const Block>;

    /// A row of blocks by global node; blocks of one node add up.
    class BlockRow
    {
    public:
      void add(const DoFIndex node, const Block &block)
      {
        if (blocks_.size() == blocks_.capacity())
        {
          merge(); // before it takes more memory
          if (2 * blocks_.size() > blocks_.capacity())
            blocks_.reserve(std::max<std::size_t>(64, 2 * blocks_.size()));
        }
        blocks_.emplace_back(node, block);
      }
      /// Ascending, each node once.
      const std::vector<std::pair<DoFIndex, Block>> &merge()
      {
        std::stable_sort(
            blocks_.begin(), blocks_.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
        std::size_t last = 0;
        for (std::size_t k = 1; k < blocks_.size(); ++k)
          if (blocks_[k].first == blocks_[last].first)
            blocks_[last].second += blocks_[k].second;
          else
            blocks_[++last] = blocks_[k];
        if (!blocks_.empty())
          blocks_.resize(last + 1);
        return blocks_;
      }
      void clear()
      {
        blocks_.clear();
      }

    private:
      std::vector<std::pair<DoFIndex, Block>> blocks_;
    };

    class Assembly
    {
    public:
      Assembly(const BlockCsrMatrix &K, const Constraints &constraints);

      AssembledMatrix matrix();

    private:
      void add_transformed_rows();
      void add_springs();
      void exchange();
      void append_row(unsigned int node, AssembledMatrix &matrix);

      bool owned(const DoFIndex node) const
      {
        return node >= first_ && node < first_ + nodes_.n_owned();
      }
      /// Local number of a node: the owned ones, then the others as in ghosts_.
      unsigned int local(const DoFIndex node) const
      {
        return owned(node)
                   ? node - first_
                   : nodes_.n_owned() + (std::lower_bound(ghosts_.begin(), ghosts_.end(), node) - ghosts_.begin());
      }

      const BlockCsrMatrix                       &K_;
      const Constraints                          &constraints_;
      const NodeMap                              &nodes_;
      const DoFIndex                              first_;
      std::vector<const NodeRow *>                T_;       ///< by local node of K; null where T is the identity
      std::vector<char>                           as_in_K_; ///< the owned rows that begin with those of K
      std::map<DoFIndex, BlockRow>                added_;   ///< to these, or the whole row
      std::vector<DoFIndex>                       ghosts_;
      BlockRow                                    row_;
      std::vector<std::pair<unsigned int, Block>> local_row_;
    };

    Assembly::Assembly(const BlockCsrMatrix &K, const Constraints &constraints)
        : K_(K)
        , constraints_(constraints)
        , nodes_(K.map())
        , first_(nodes_.n_owned() > 0 ? nodes_.global(0) : 0)
        , T_(nodes_.size(), nullptr)
        , as_in_K_(nodes_.n_owned(), 1)
    {
      if (constraints.T)
        for (const auto &[node, row] : constraints.T->rows())
          T_[node] = &row;
    }

    /// T^T K T in the rows in which it is not K.
    void Assembly::add_transformed_rows()
    {
      for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
      {
        bool same = !T_[i];
        K_.for_row(i, [&](const unsigned int c, const double *, const bool) { same = same && !T_[c]; });
        if (same)
          continue;
        as_in_K_[i] = 0;
        row_.clear(); // of K T
        K_.for_row(i,
                   [&](const unsigned int c, const double *const values, const bool transposed)
                   {
                     const Block block = transposed ? Block(BlockMap(values).transpose()) : Block(BlockMap(values));
                     if (!T_[c])
                       row_.add(nodes_.global(c), block);
                     else
                       for (const auto &[node, T] : *T_[c])
                         row_.add(node, block * BlockMap(T.data()));
                   });
        for (const auto &[column, block] : row_.merge())
          if (!T_[i])
            added_[nodes_.global(i)].add(column, block);
          else
            for (const auto &[node, T] : *T_[i])
              added_[node].add(column, BlockMap(T.data()).transpose() * block);
      }
    }

    void Assembly::add_springs()
    {
      for (const auto &spring : constraints_.springs)
        for (const auto &[row, R] : spring.row)
        {
          const Block force = BlockMap(R.data()).transpose() * BlockMap(spring.D.data());
          for (const auto &[column, other] : spring.row)
            added_[row].add(column, force * BlockMap(other.data()));
        }
      for (const auto &[i, d] : constraints_.diagonal)
      {
        Block block             = Block::Zero();
        block(i % dim, i % dim) = d;
        added_[first_ + i / dim].add(first_ + i / dim, block);
      }
    }

    /// Hands what belongs to rows of other ranks to these.
    void Assembly::exchange()
    {
      std::map<unsigned int, std::vector<double>> outgoing; // row, column, block
      for (auto it = added_.begin(); it != added_.end();)
      {
        if (owned(it->first))
        {
          ++it;
          continue;
        }
        std::vector<double> &numbers = outgoing[nodes_.owner(it->first)];
        for (const auto &[column, block] : it->second.merge())
        {
          numbers.insert(numbers.end(), {static_cast<double>(it->first), static_cast<double>(column)});
          append(numbers, block);
        }
        it = added_.erase(it);
      }
      for (const auto &[rank, numbers] : sparse_exchange(nodes_.communicator(), outgoing))
        for (const double *p = numbers.data(); p != numbers.data() + numbers.size();)
        {
          const auto row = static_cast<DoFIndex>(p[0]), column = static_cast<DoFIndex>(p[1]);
          p += 2;
          added_[row].add(column, read(p));
        }
    }

    void Assembly::append_row(const unsigned int node, AssembledMatrix &matrix)
    {
      local_row_.clear();
      if (as_in_K_[node])
        K_.for_row(node,
                   [&](const unsigned int c, const double *const values, const bool transposed)
                   {
                     local_row_.emplace_back(local(nodes_.global(c)),
                                             transposed ? Block(BlockMap(values).transpose())
                                                        : Block(BlockMap(values)));
                   });
      if (const auto found = added_.find(first_ + node); found != added_.end())
      {
        const auto here = [](const auto &entry, const unsigned int c) { return entry.first < c; };
        std::sort(local_row_.begin(), local_row_.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
        const std::size_t n = local_row_.size();
        for (const auto &[column, block] : found->second.merge())
        {
          const unsigned int c     = local(column);
          const auto         place = std::lower_bound(local_row_.begin(), local_row_.begin() + n, c, here);
          if (place != local_row_.begin() + n && place->first == c)
            place->second += block;
          else
            local_row_.emplace_back(c, block);
        }
        added_.erase(found);
      }
      std::sort(local_row_.begin(), local_row_.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
      // prescribed displacements and those that contact eliminates have rows and columns of zeros
      bool held[dim] = {true, true, true};
      for (const auto &[c, block] : local_row_)
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            held[a] = held[a] && ((c == node && a == b) || block(a, b) == 0.);
      for (unsigned int a = 0; a < dim; ++a)
      {
        for (const auto &[c, block] : local_row_)
          for (unsigned int b = 0; b < dim; ++b)
            if (c == node ? a == b || !(held[a] || held[b]) : !(block.row(a).isZero(0.) || block.col(b).isZero(0.)))
            {
              matrix.column.push_back(dim * c + b);
              matrix.value.push_back(block(a, b));
            }
        matrix.start.push_back(matrix.value.size());
      }
    }

    AssembledMatrix Assembly::matrix()
    {
      add_transformed_rows();
      add_springs();
      exchange();

      for (unsigned int g = nodes_.n_owned(); g < nodes_.size(); ++g)
        ghosts_.push_back(nodes_.global(g));
      std::size_t n_blocks = 0;
      for (auto &[node, row] : added_)
        for (const auto &[column, block] : row.merge())
        {
          ++n_blocks;
          if (!owned(column))
            ghosts_.push_back(column);
        }
      make_unique_ascending(ghosts_);
      for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
        if (as_in_K_[i])
          K_.for_row(i, [&](unsigned int, const double *, bool) { ++n_blocks; });

      AssembledMatrix matrix;
      matrix.communicator = nodes_.communicator();
      matrix.n_owned      = dim * nodes_.n_owned();
      for (unsigned int i = 0; i < nodes_.n_owned() + ghosts_.size(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          matrix.unknowns.push_back(
              static_cast<long long>(dim) * (i < nodes_.n_owned() ? first_ + i : ghosts_[i - nodes_.n_owned()]) + c);
      matrix.start.reserve(matrix.n_owned + 1);
      matrix.start.push_back(0);
      matrix.column.reserve(dim * dim * n_blocks);
      matrix.value.reserve(dim * dim * n_blocks);
      for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
        append_row(i, matrix);
      return matrix;
    }
  } // namespace

  AssembledMatrix assemble(const BlockCsrMatrix &K, const Constraints &constraints)
  {
    return Assembly(K, constraints).matrix();
  }
} // namespace Nodus
