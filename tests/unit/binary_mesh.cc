// Binary gmsh files (tests/meshes/cylinder.geo, 27-node hexahedra) in both formats: the mesh of the text file to
// its last digit; cut off anywhere or damaged anywhere they are refused in a sentence or read, and nothing of a size
// that the file does not have is asked for.

#include "mesh/gmsh_reader.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>
#include <random>

namespace
{
  std::size_t largest = 0; ///< piece of memory that was asked for
}

void *operator new(const std::size_t size)
{
  largest = std::max(largest, size);
  if (void *const memory = std::malloc(size))
    return memory;
  throw std::bad_alloc();
}
void *operator new(const std::size_t size, const std::nothrow_t &) noexcept
{
  largest = std::max(largest, size);
  return std::malloc(size);
}
void operator delete(void *memory) noexcept
{
  std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept
{
  std::free(memory);
}

using namespace Nodus;

namespace
{
  const std::string folder = SOURCE_DIR "/../meshes/";

  std::string content(const std::string &name)
  {
    std::ifstream in(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  void write(const std::string &text)
  {
    std::ofstream("damaged.msh", std::ios::binary) << text;
  }

  bool same(const CoarseMesh &a, const CoarseMesh &b)
  {
    bool result = a.vertices.size() == b.vertices.size() && a.cells.size() == b.cells.size() &&
                  a.curved.size() == b.curved.size() &&
                  a.boundary.boundary_quads.size() == b.boundary.boundary_quads.size();
    const auto near = [](const Point &x, const Point &y) { return x.distance(y) < 1e-15; }; // the text has 16 digits
    for (unsigned int v = 0; result && v < a.vertices.size(); ++v)
      result = near(a.vertices[v], b.vertices[v]);
    for (unsigned int c = 0; result && c < a.cells.size(); ++c)
      result = a.cells[c].vertices == b.cells[c].vertices;
    for (unsigned int c = 0; result && c < a.curved.size(); ++c)
      result = std::equal(a.curved[c].nodes.begin(), a.curved[c].nodes.end(), b.curved[c].nodes.begin(), near);
    for (unsigned int q = 0; result && q < a.boundary.boundary_quads.size(); ++q)
      result = a.boundary.boundary_quads[q].vertices == b.boundary.boundary_quads[q].vertices &&
               a.boundary.boundary_quads[q].boundary_id == b.boundary.boundary_quads[q].boundary_id;
    return result;
  }

  /// 'r' refused in a sentence, 'a' accepted, 'o' anything else.
  char outcome(std::string &message)
  {
    try
    {
      GmshFile("damaged.msh").body({});
      return 'a';
    }
    catch (const InputError &error)
    {
      message = error.what();
      return 'r';
    }
    catch (const std::exception &error)
    {
      message = error.what();
      return 'o';
    }
  }

  void refused(const std::string &what, const std::string &text)
  {
    write(text);
    std::string message;
    std::cout << what << ": " << (outcome(message) == 'r' ? message : "NO") << '\n';
  }

  std::string replaced(std::string text, const std::size_t at, const std::string &by)
  {
    return text.replace(at, by.size(), by);
  }

  template <typename Number>
  std::string bytes(const Number number)
  {
    return std::string(reinterpret_cast<const char *>(&number), sizeof(number));
  }

  /// @p count: put in the place of one, so many bytes behind the line after the word @p before.
  void check(const std::string &name, const std::string &before, const std::size_t behind, const std::string &count_of)
  {
    const std::string file = folder + name + ".msh", text = content(file);
    std::cout << name << '\n';
    std::cout << "mesh of the text file: "
              << (same(GmshFile(file).body({}), GmshFile(folder + "cylinder_27_1.msh").body({})) ? "yes" : "NO")
              << '\n';
    refused("other order of bytes", replaced(text, 20, std::string("\0\0\0\1", 4)));
    refused("no mark of the order", replaced(text, 20, "abcd"));
    refused("numbers of 4 bytes", replaced(text, 18, "4"));
    const std::size_t section = text.find(before) + before.size() + 1;
    refused("too many", replaced(text, section + behind, count_of));
    refused("cut", text.substr(0, text.size() / 2));

    std::string  message, other;
    unsigned int n[3]  = {0, 0, 0};
    const auto   count = [&](const char result)
    {
      ++n[result == 'r' ? 0 : result == 'a' ? 1 : 2];
      if (result == 'o')
        other = message;
    };
    largest = 0;
    for (std::size_t size = 0; size < text.size(); ++size)
    {
      write(text.substr(0, size));
      count(outcome(message));
    }
    std::cout << "cut behind each byte: " << n[0] << " refused, " << n[1] << " read, "
              << (n[2] == 0 ? "no other end" : "NO: " + other) << '\n';

    std::fill(n, n + 3, 0);
    std::mt19937 random(1);
    for (unsigned int i = 0; i < 4000; ++i)
    {
      std::string        damaged = text;
      const unsigned int m       = 1 + random() % 4; // bytes, of which counts have several
      const std::size_t  at      = random() % (text.size() - m);
      for (unsigned int j = 0; j < m; ++j)
        damaged[at + j] = random() % 3 == 0 ? '\xff' : static_cast<char>(random());
      write(damaged);
      count(outcome(message));
    }
    std::cout << "some bytes are others: " << (n[2] == 0 ? "refused or read" : "NO: " + other) << ", of 4000 "
              << (n[0] > 1000 ? "more" : "NO more") << " than 1000 refused\n";
    std::cout << "memory at once: " << (largest < 100 * text.size() ? "less" : "NO less")
              << " than 100 times the file\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check("cylinder_27_1_binary", "$Nodes", 4 * sizeof(std::size_t) + 3 * sizeof(int), bytes(std::size_t(1) << 60));
  check("cylinder_27_1_binary_format_22", "$Elements\n19", 2 * sizeof(int), bytes(1 << 30));
}
