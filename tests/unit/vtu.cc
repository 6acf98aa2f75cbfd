// Output of a deformed two-body model: the volume of the cells in the files is that of the deformation, for linear and
// quadratic cells; stresses of a homogeneous deformation are exact at the nodes; all contact fields are there; nothing
// temporary stays behind; a folder that cannot be made is reported on every rank.

#include "output/vtu.h"
#include "output/results_folder.h"

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <sstream>

using namespace Nodus;
using dealii::Utilities::MPI::this_mpi_process;

namespace
{
  /// The arrays of all pieces `stem`*.vtu, one after the other: base64 of (1, size, size, compressed size),
  /// then base64 of the zlib data.
  class Vtu
  {
  public:
    Vtu(const std::string &folder, const std::string &stem)
    {
      for (const auto &entry : std::filesystem::directory_iterator(folder))
        if (entry.path().filename().string().rfind(stem, 0) == 0 && entry.path().extension() == ".vtu")
          add_piece(entry.path().string());
    }

    std::map<std::string, std::vector<double>> values;
    std::map<std::string, unsigned int>        components;

  private:
    void add_piece(const std::string &name)
    {
      std::stringstream text;
      text << std::ifstream(name).rdbuf();
      const std::string  all = text.str();
      const std::regex   array("<DataArray type=\"([A-Za-z0-9]*)\"([^>]*)format=\"binary\">\\s*([A-Za-z0-9+/=]*)"
                               "\\s*</DataArray>");
      const unsigned int n_points_before = values["Points"].size() / dim;
      for (std::sregex_iterator i(all.begin(), all.end(), array), end; i != end; ++i)
      {
        const std::string attributes = (*i)[2];
        std::smatch       match;
        std::string       key = "Points";
        if (std::regex_search(attributes, match, std::regex("Name=\"([^\"]*)\"")))
          key = match[1];
        components[key] =
            std::regex_search(attributes, match, std::regex("NumberOfComponents=\"([0-9]*)\"")) ? stoi(match[1]) : 1;
        for (const double value : decode((*i)[1], (*i)[3]))
          values[key].push_back(value + (key == "connectivity" ? n_points_before : 0));
      }
    }

    template <typename T>
    static std::vector<double> as(const std::string &bytes)
    {
      std::vector<T> data(bytes.size() / sizeof(T));
      std::memcpy(data.data(), bytes.data(), data.size() * sizeof(T));
      return {data.begin(), data.end()};
    }

    static std::vector<double> decode(const std::string &type, const std::string &text)
    {
      const auto header_size = 24; // four 32-bit integers in base64
      const auto data        = dealii::Utilities::decode_base64(text.substr(header_size));

      std::istringstream compressed(std::string(data.begin(), data.end()));
      std::ostringstream bytes;

      boost::iostreams::filtering_streambuf<boost::iostreams::input> in;
      in.push(boost::iostreams::zlib_decompressor());
      in.push(compressed);
      boost::iostreams::copy(in, bytes);
      return type == "Float32" ? as<float>(bytes.str())
             : type == "Int32" ? as<std::int32_t>(bytes.str())
                               : as<std::uint8_t>(bytes.str());
    }
  };

  /// Volume of the cells (VTK corner order), for second-order cells of their 27-node tensor-product geometry.
  double volume(const Vtu &vtu, const unsigned int degree)
  {
    // corners, edges, faces, centre of vtkTriQuadraticHexahedron as (i, j, k) of the 3x3x3 grid
    const unsigned int      grid[27][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
                                           {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
                                           {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}, {0, 1, 1},
                                           {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}, {1, 1, 1}};
    const dealii::FE_Q<dim> fe(degree);
    const dealii::QGauss<dim> quadrature(degree + 2);
    const unsigned int        n_nodes = fe.n_dofs_per_cell();

    // node of the finite element that sits where the node of the VTK cell does
    std::vector<unsigned int> dof(n_nodes);
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (unsigned int i = 0; i < n_nodes; ++i)
        if (fe.unit_support_point(i).distance(Point(grid[a][0] / 2., grid[a][1] / 2., grid[a][2] / 2.)) < 1e-10)
          dof[a] = i;

    const auto &points       = vtu.values.at("Points");
    const auto &connectivity = vtu.values.at("connectivity");
    double      sum          = 0.;
    for (unsigned int cell = 0; cell < connectivity.size() / n_nodes; ++cell)
      for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        dealii::Tensor<2, dim> jacobian;
        for (unsigned int a = 0; a < n_nodes; ++a)
        {
          const std::size_t node     = connectivity[cell * n_nodes + a];
          const auto        gradient = fe.shape_grad(dof[a], quadrature.point(q));
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int j = 0; j < dim; ++j)
              jacobian[i][j] += points[3 * node + i] * gradient[j];
        }
        sum += dealii::determinant(jacobian) * quadrature.weight(q);
      }
    return sum;
  }

  /// det F = 1.32, volume of two unit cubes 2.64; with the bulge 1.32 (1 + 0.4 x (1 - x)) and 2.816 for quadratic
  /// cells, 2.772 for linear cells of size 1/2.
  class Deformation : public dealii::Function<dim>
  {
  public:
    explicit Deformation(const bool bulge)
        : dealii::Function<dim>(dim)
        , bulge_(bulge)
    {
    }
    void vector_value(const Point &X, dealii::Vector<double> &u) const override
    {
      u[0] = 0.1 * X[0] + 0.2 * X[1];
      u[1] = 0.2 * X[1];
      u[2] = bulge_ ? 0.4 * X[2] * X[0] * (1. - X[0]) : 0.;
    }

  private:
    bool bulge_;
  };

  /// The top of the unit cube as a slave surface of one face.
  ContactFields contact_on_top(const unsigned int degree)
  {
    ContactFields c;
    c.name   = "top";
    c.degree = degree;
    c.faces.resize(1);
    for (unsigned int j = 0; j <= degree; ++j)
      for (unsigned int i = 0; i <= degree; ++i)
      {
        const Point X(double(i) / degree, double(j) / degree, 1.);
        c.faces[0].push_back(c.X.size());
        c.X.push_back(X);
        c.displacement.push_back(Vector3({0., 0., 0.5}));
        c.pressure.push_back(10. * X[0]);
        c.gap.push_back(X[1]);
        c.friction.push_back(Vector3({1., 2., 0.}));
        c.shear[0].push_back(1.);
        c.shear[1].push_back(2.);
        c.slip[0].push_back(3.);
        c.slip[1].push_back(4.);
        c.status.push_back(ContactStatus::stick);
        c.normal.push_back(Vector3({0., 0., 1.}));
        c.tangent1.push_back(Vector3({1., 0., 0.}));
        c.area.push_back(0.25);
        c.status_changes.push_back(3);
        c.cycle_period.push_back(2);
        c.contradiction.push_back(1);
        c.paired.push_back(1);
        c.node.push_back(c.node.size());
      }
    return c;
  }

  void print_range(const std::string &name, const Vtu &vtu)
  {
    const auto &values = vtu.values.at(name);
    const auto  range  = std::minmax_element(values.begin(), values.end());
    std::cout << "  " << name << " (" << vtu.components.at(name) << "): " << *range.first << " to " << *range.second
              << '\n';
  }

  BodyParameters cube(const double bottom)
  {
    BodyParameters body;
    body.generator               = "hyper_cube";
    body.generator_arguments     = "0 : 1 : true";
    body.global_refinement       = 1;
    body.translation[2]          = bottom;
    body.material.youngs_modulus = 1.;
    return body;
  }

  void test(const unsigned int degree, const bool bulge)
  {
    const MPI_Comm communicator = MPI_COMM_WORLD;
    const bool     root         = this_mpi_process(communicator) == 0;

    const std::vector<BodyParameters> parameters = {cube(0.), cube(2.)};
    const Bodies                      bodies(parameters, communicator);

    std::vector<std::unique_ptr<Material>> materials;
    for (const auto &body : parameters)
      materials.push_back(make_material(body.material));

    const dealii::FESystem<dim> fe(dealii::FE_Q<dim>(degree), dim);
    dealii::DoFHandler<dim>     dof_handler(bodies.triangulation());
    dof_handler.distribute_dofs(fe);
    const dealii::IndexSet       relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
    const dealii::MappingQ1<dim> mapping;
    Vector                       owned(dof_handler.locally_owned_dofs(), communicator);
    dealii::VectorTools::interpolate(mapping, dof_handler, Deformation(bulge), owned);
    Vector u(dof_handler.locally_owned_dofs(), relevant, communicator);
    u = owned;

    const std::string folder = "vtu_results/degree_" + std::to_string(degree) + (bulge ? "_bulge" : "");
    if (root)
      std::filesystem::remove_all(folder);
    MPI_Barrier(communicator);

    // the face belongs to rank 0
    ContactFields top = contact_on_top(degree);
    if (!root)
      top.faces.clear();
    std::vector<BoundaryConditions::Load> none;
    const SolidAssembler                  solid(dof_handler, mapping, materials, none);
    const ResultsFolder                   held(folder, communicator);
    OutputParameters                      chosen;
    chosen.results_folder = folder;
    chosen.configuration  = OutputParameters::Configuration::deformed;
    VtuOutput output(chosen, bodies, dof_handler, mapping, solid, false);
    output.write(1, 0.5, u, {top});
    output.write(2, 1.0, u, {top, top});

    if (!root)
      return;
    std::cout << "degree " << degree << (bulge ? ", bulge" : ", homogeneous") << '\n';
    unsigned int incomplete = 0;
    for (const auto &entry : std::filesystem::directory_iterator(folder))
      incomplete += entry.path().extension() != ".vtu" && entry.path().extension() != ".pvtu" &&
                    entry.path().extension() != ".pvd";
    std::cout << "  files that are no results: " << incomplete << '\n'
              << "  volume of both bodies: " << volume(Vtu(folder, "bodies_0002"), degree) << '\n'
              << "  contact faces of two pairs: " << Vtu(folder, "contact_0002").values["offsets"].size() << '\n';

    const Vtu bodies_vtu(folder, "bodies_0001"), contact_vtu(folder, "contact_0001");
    for (const auto &name : {"displacement", "von_mises"})
      print_range(name, bodies_vtu);
    if (!bulge)
    {
      dealii::Tensor<2, dim> F = dealii::unit_symmetric_tensor<dim>();
      F[0][0]                  = 1.1;
      F[0][1]                  = 0.2;
      F[1][1]                  = 1.2;
      const auto  exact        = materials[0]->cauchy_stress(F);
      const auto &stress       = bodies_vtu.values.at("cauchy_stress");
      double      error        = 0.;
      for (unsigned int i = 0; i < stress.size(); ++i)
        error = std::max(error, std::abs(stress[i] - exact[(i / dim) % dim][i % dim]));
      std::cout << "  error of the nodal stress below 1e-6: " << (error < 1e-6 ? "yes" : "no") << '\n';
    }
    for (const auto &[name, unused] : contact_vtu.values)
      if (name != "types" && name != "connectivity" && name != "offsets")
        print_range(name, contact_vtu);
    std::ifstream pvd(folder + "/contact.pvd");
    unsigned int  n_times = 0;
    for (std::string line; std::getline(pvd, line);)
      n_times += line.find("<DataSet timestep=") != std::string::npos;
    std::cout << "  times in contact.pvd: " << n_times << std::endl;
  }
} // namespace

int main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int degree : {1, 2})
    for (const bool bulge : {false, true})
      test(degree, bulge);

  // a file where the folder should be
  if (this_mpi_process(MPI_COMM_WORLD) == 0)
    std::ofstream("vtu_results/file") << '\n';
  MPI_Barrier(MPI_COMM_WORLD);
  unsigned int refused = 0;
  try
  {
    ResultsFolder("vtu_results/file/folder", MPI_COMM_WORLD);
  }
  catch (const InputError &error)
  {
    refused = 1;
    if (this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << error.what() << '\n';
  }
  refused = dealii::Utilities::MPI::min(refused, MPI_COMM_WORLD);
  if (this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "refused on every rank: " << refused << std::endl;
}
