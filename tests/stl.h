#ifndef nodus_tests_stl_h
#define nodus_tests_stl_h

// Surfaces of triangles, counter-clockwise from outside, and STL files of them.

#include <nodus/base/types.h>

#include <deal.II/base/numbers.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <string>
#include <vector>

namespace Stl
{
  using Nodus::Point;
  using Nodus::Vector3;
  using Triangles = std::vector<std::array<Point, 3>>;

  /// 20 * 4^levels triangles with their corners on a sphere about the origin.
  inline Triangles icosphere(const unsigned int levels, const double radius)
  {
    const double       g = 0.5 * (1. + std::sqrt(5.));
    std::vector<Point> v;
    for (const double a : {-1., 1.})
      for (const double b : {-g, g})
        for (unsigned int c = 0; c < 3; ++c)
        {
          Point p;
          p[c]           = a;
          p[(c + 1) % 3] = b;
          v.push_back(p);
        }
    const auto on_sphere = [radius](const Vector3 &x) { return Point(radius / x.norm() * x); };
    Triangles  result;
    for (unsigned int i = 0; i < v.size(); ++i)
      for (unsigned int j = i + 1; j < v.size(); ++j)
        for (unsigned int k = j + 1; k < v.size(); ++k)
          if (v[i].distance(v[j]) < 2.1 && v[j].distance(v[k]) < 2.1 && v[k].distance(v[i]) < 2.1)
          {
            const bool outward =
                dealii::cross_product_3d(Vector3(v[j] - v[i]), Vector3(v[k] - v[i])) * Vector3(v[i]) > 0.;
            result.push_back({{on_sphere(v[i]), on_sphere(v[outward ? j : k]), on_sphere(v[outward ? k : j])}});
          }
    for (unsigned int level = 0; level < levels; ++level)
    {
      Triangles finer;
      for (const auto &[a, b, c] : result)
      {
        const Point ab = on_sphere(Vector3(a) + Vector3(b)), bc = on_sphere(Vector3(b) + Vector3(c)),
                    ca = on_sphere(Vector3(c) + Vector3(a));
        for (const auto &t : {std::array<Point, 3>{{a, ab, ca}}, {{ab, b, bc}}, {{ca, bc, c}}, {{ab, bc, ca}}})
          finer.push_back(t);
      }
      result = finer;
    }
    return result;
  }

  /// The parallelogram from @p origin along @p e and @p f in n times n parts, facing e x f.
  inline Triangles plate(const Point &origin, const Vector3 &e, const Vector3 &f, const unsigned int n)
  {
    Triangles result;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
      {
        const auto at = [&](const unsigned int a, const unsigned int b)
        { return origin + (i + a) / double(n) * e + (j + b) / double(n) * f; };
        result.push_back({{at(0, 0), at(1, 0), at(1, 1)}});
        result.push_back({{at(0, 0), at(1, 1), at(0, 1)}});
      }
    return result;
  }

  /// The box [lower, upper], its sides in n times n parts.
  inline Triangles box(const Point &lower, const Point &upper, const unsigned int n)
  {
    Triangles result;
    for (unsigned int c = 0; c < 3; ++c)
    {
      Vector3 e, f;
      e[(c + 1) % 3] = upper[(c + 1) % 3] - lower[(c + 1) % 3];
      f[(c + 2) % 3] = upper[(c + 2) % 3] - lower[(c + 2) % 3];
      Point top      = lower;
      top[c]         = upper[c];
      for (const auto &side : {plate(lower, f, e, n), plate(top, e, f, n)})
        result.insert(result.end(), side.begin(), side.end());
    }
    return result;
  }

  /// A cylinder about z from z = 0 to @p length, with caps of @p n sectors; its side is one triangle high.
  inline Triangles cylinder(const double radius, const double length, const unsigned int n)
  {
    Triangles  result;
    const auto at = [&](const unsigned int i, const double z)
    {
      const double phi = 2. * dealii::numbers::PI * (i % n) / n;
      return Point(radius * std::cos(phi), radius * std::sin(phi), z);
    };
    for (unsigned int i = 0; i < n; ++i)
    {
      result.push_back({{at(i, 0.), at(i + 1, 0.), at(i + 1, length)}});
      result.push_back({{at(i, 0.), at(i + 1, length), at(i, length)}});
      result.push_back({{Point(0., 0., 0.), at(i + 1, 0.), at(i, 0.)}});
      result.push_back({{Point(0., 0., length), at(i, length), at(i + 1, length)}});
    }
    return result;
  }

  inline void write_binary(const std::string &file, const Triangles &triangles)
  {
    std::ofstream stream(file, std::ios::binary);
    const auto    write = [&stream](const std::uint32_t bits)
    {
      for (unsigned int i = 0; i < 4; ++i)
        stream.put(static_cast<char>(bits >> 8 * i & 0xff));
    };
    stream << std::string("made by a test of nodus").append(80, ' ').substr(0, 80);
    write(triangles.size());
    for (const auto &triangle : triangles)
    {
      for (unsigned int i = 0; i < 3; ++i)
        write(0); // the normal is left to the reader
      for (const Point &p : triangle)
        for (unsigned int c = 0; c < 3; ++c)
        {
          const float   x = static_cast<float>(p[c]);
          std::uint32_t bits;
          std::memcpy(&bits, &x, sizeof bits);
          write(bits);
        }
      stream.put(0);
      stream.put(0);
    }
  }

  inline void write_ascii(const std::string &file, const Triangles &triangles)
  {
    std::ofstream stream(file);
    stream << std::setprecision(17) << "solid made by a test of nodus\n";
    for (const auto &triangle : triangles)
    {
      stream << "  facet normal 0 0 0\n    outer loop\n";
      for (const Point &p : triangle)
        stream << "      vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      stream << "    endloop\n  endfacet\n";
    }
    stream << "endsolid made by a test of nodus\n";
  }
} // namespace Stl

#endif
