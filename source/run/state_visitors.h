#ifndef nodus_run_state_visitors_h
#define nodus_run_state_visitors_h

#include "run/state.h"

#include <algorithm>
#include <array>
#include <vector>

namespace Nodus
{
  /// Visitors of the members of a State (visit_members()) that turn them into numbers and back.
  namespace StateVisitors
  {
    // Values as numbers: how many, to them, from them.
    constexpr unsigned int width(const char *)
    {
      return 1;
    }
    constexpr unsigned int width(const double *)
    {
      return 1;
    }
    template <std::size_t n>
    constexpr unsigned int width(const std::array<double, n> *)
    {
      return n;
    }
    constexpr unsigned int width(const Vector3 *)
    {
      return dim;
    }
    constexpr unsigned int width(const std::array<Vector3, 2> *)
    {
      return 2 * dim;
    }

    inline double *write(const char value, double *to)
    {
      *to = value;
      return to + 1;
    }
    inline double *write(const double value, double *to)
    {
      *to = value;
      return to + 1;
    }
    template <std::size_t n>
    double *write(const std::array<double, n> &value, double *to)
    {
      return std::copy(value.begin(), value.end(), to);
    }
    inline double *write(const Vector3 &value, double *to)
    {
      for (unsigned int c = 0; c < dim; ++c)
        *to++ = value[c];
      return to;
    }
    inline double *write(const std::array<Vector3, 2> &value, double *to)
    {
      return write(value[1], write(value[0], to));
    }

    inline const double *read(const double *from, char &value)
    {
      value = *from > 0.5; // or between those of others, on a new mesh
      return from + 1;
    }
    inline const double *read(const double *from, double &value)
    {
      value = *from;
      return from + 1;
    }
    template <std::size_t n>
    const double *read(const double *from, std::array<double, n> &value)
    {
      std::copy_n(from, n, value.begin());
      return from + n;
    }
    inline const double *read(const double *from, Vector3 &value)
    {
      std::copy_n(from, dim, &value[0]);
      return from + dim;
    }
    inline const double *read(const double *from, std::array<Vector3, 2> &value)
    {
      return read(read(from, value[0]), value[1]);
    }

    /// Visits nothing; what a visitor below does visit hides these.
    struct Nothing
    {
      template <typename... Arguments>
      void nodes(Arguments &&...)
      {
      }
      template <typename... Arguments>
      void multipliers(Arguments &&...)
      {
      }
      template <typename... Arguments>
      void slaves(Arguments &&...)
      {
      }
      template <typename... Arguments>
      void sites(Arguments &&...)
      {
      }
      template <typename... Arguments>
      void cells(Arguments &&...)
      {
      }
      template <typename... Arguments>
      void common(Arguments &&...)
      {
      }
    };

    struct Widths : public Nothing
    {
      unsigned int node_vectors = 0, site = 0, slave = 0;

      void nodes(const Vector &)
      {
        ++node_vectors;
      }
      template <typename T>
      void sites(const std::vector<T> &)
      {
        site += width(static_cast<const T *>(nullptr));
      }
      template <typename T>
      void slaves(const std::vector<T> &)
      {
        slave += width(static_cast<const T *>(nullptr));
      }
      void multipliers(const Vector &, const unsigned int n)
      {
        slave += n;
      }
    };
    inline const Widths &widths()
    {
      static const Widths counted = []
      {
        State  any;
        Widths w;
        any.unknowns.reinit(3);
        visit_members(any, w);
        return w;
      }();
      return counted;
    }

    struct SiteWriter : public Nothing
    {
      unsigned int site;
      double      *to;
      template <typename T>
      void sites(const std::vector<T> &values)
      {
        to = write(values[site], to);
      }
    };
    struct SiteReader : public Nothing
    {
      unsigned int  site;
      const double *from;
      template <typename T>
      void sites(std::vector<T> &values)
      {
        from = read(from, values[site]);
      }
    };
    struct SlaveWriter : public Nothing
    {
      unsigned int slave;
      DoFIndex     multiplier;
      double      *to;
      void         multipliers(const Vector &values, const unsigned int n)
      {
        for (unsigned int i = 0; i < n; ++i)
          *to++ = values(n * multiplier + i);
      }
      template <typename T>
      void slaves(const std::vector<T> &values)
      {
        to = write(values[slave], to);
      }
    };
    struct SlaveReader : public Nothing
    {
      unsigned int  slave;
      DoFIndex      multiplier;
      const double *from;
      void          multipliers(Vector &values, const unsigned int n)
      {
        for (unsigned int i = 0; i < n; ++i)
          values(n * multiplier + i) = *from++;
      }
      template <typename T>
      void slaves(std::vector<T> &values)
      {
        from = read(from, values[slave]);
      }
    };
    struct NodeVectors : public Nothing
    {
      std::vector<const Vector *> vectors;
      void                        nodes(const Vector &v)
      {
        vectors.push_back(&v);
      }
    };
    struct NodeVectorReader : public Nothing
    {
      const Vector *from;
      void          nodes(Vector &v)
      {
        v = *from++;
      }
    };

    struct Places : public Nothing
    {
      const void  *wanted;
      unsigned int next = 0, found = 0;
      template <typename T>
      void sites(const std::vector<T> &values)
      {
        if (&values == wanted)
          found = next;
        next += width(static_cast<const T *>(nullptr));
      }
    };
    /// Where a member begins among the values of a site.
    template <typename T>
    unsigned int place_of(const std::vector<T> &member, const State &state)
    {
      Places places;
      places.wanted = &member;
      visit_members(state, places);
      return places.found;
    }
  } // namespace StateVisitors
} // namespace Nodus

#endif
