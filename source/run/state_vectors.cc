#include "run/state_vectors.h"
#include "run/state_visitors.h"

#include <deal.II/base/mpi.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace Nodus
{
  using namespace StateVisitors;

  namespace
  {
    /// Numbers of a slave node: those of its site, its own, and Lambda in space where they are to be interpolated.
    unsigned int n_slave_numbers()
    {
      return n_site_values() + widths().slave + dim;
    }

    unsigned int vectors_of_layer()
    {
      return (n_slave_numbers() + dim - 1) / dim;
    }

    /// Of the vectors with the numbers of slave node @p k: each layer of pairs has its own.
    unsigned int first_vector(const ContactSurfaces &surfaces, const unsigned int k)
    {
      return n_displacement_vectors() + surfaces.layers()[surfaces.pair(k)] * vectors_of_layer();
    }

    /// Place of number @p i of slave node @p k in its vector.
    DoFIndex dof(const ContactSurfaces &surfaces, const unsigned int k, const unsigned int i)
    {
      return surfaces.nodes()[surfaces.slave_nodes()[k].node].dofs[i % dim];
    }

    /// The vectors of a state whose slave nodes have the numbers that @p numbers(k) returns.
    template <typename Numbers>
    std::vector<Vector> as_vectors(const State &state, const ContactInterface &contact, const Numbers &numbers)
    {
      const ContactSurfaces &surfaces = contact.surfaces();
      NodeVectors            of_nodes;
      visit_members(state, of_nodes);
      std::vector<Vector> vectors;
      for (const Vector *const v : of_nodes.vectors)
        vectors.push_back(*v);
      while (vectors.size() < n_state_vectors(surfaces))
        vectors.emplace_back(surfaces.layout().owned[0], surfaces.layout().communicator);
      for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
      {
        const std::vector<double> values = numbers(k);
        for (unsigned int i = 0; i < values.size(); ++i)
          vectors[first_vector(surfaces, k) + i / dim](dof(surfaces, k, i)) = values[i];
      }
      for (unsigned int n = n_displacement_vectors(); n < vectors.size(); ++n)
        vectors[n].compress(dealii::VectorOperation::insert);
      return vectors;
    }

    /// Numbers of an own slave node among the vectors.
    std::vector<double>
    numbers_of(const std::vector<Vector> &vectors, const ContactSurfaces &surfaces, const unsigned int k)
    {
      std::vector<double> values(n_slave_numbers());
      for (unsigned int i = 0; i < values.size(); ++i)
        values[i] = vectors[first_vector(surfaces, k) + i / dim](dof(surfaces, k, i));
      return values;
    }

    void write_slave(const State &state, const ContactSurfaces &surfaces, const unsigned int k, double *const to)
    {
      SlaveWriter writer{{}, k, surfaces.multiplier(k), to};
      visit_members(state, writer);
    }

    void set_sites(std::vector<double> sites, const ContactSurfaces &surfaces, State &state)
    {
      surfaces.site_exchange().update(sites, n_site_values());
      for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      {
        SiteReader reader{{}, s, sites.data() + s * n_site_values()};
        visit_members(state, reader);
      }
    }

    void set_nodes(const std::vector<Vector> &vectors, State &state)
    {
      NodeVectorReader reader{{}, vectors.data()};
      visit_members(state, reader);
    }

    /// Site values of the slave nodes; those of the integration point scheme have the mean of the points around them.
    /// Right at own nodes. Collective.
    std::vector<double> node_values(const State &state, const ContactInterface &contact)
    {
      const ContactSurfaces &surfaces = contact.surfaces();
      const unsigned int     n = n_site_values(), n_slaves = surfaces.slave_nodes().size();
      std::vector<double>    values(n * n_slaves, 0.), sums((n + 1) * n_slaves, 0.);
      const unsigned int     rank = dealii::Utilities::MPI::this_mpi_process(surfaces.layout().communicator);
      for (const ContactPoint &point : contact.weights().points())
        if (point.site != dealii::numbers::invalid_unsigned_int && point.owner == rank)
        {
          const std::vector<double> here = site_values(state, point.site);
          for (unsigned int a = 0; a < point.slaves.size(); ++a)
          {
            double *const sum  = sums.data() + (n + 1) * point.slaves[a];
            const double  part = point.weight * std::abs(point.shape[a]);
            for (unsigned int i = 0; i < n; ++i)
              sum[i] += part * here[i];
            sum[n] += part;
          }
        }
      surfaces.slave_exchange().sum(sums, n + 1);
      for (unsigned int k = 0; k < n_slaves; ++k)
        if (surfaces.has_status(k))
        {
          const std::vector<double> own = site_values(state, k);
          std::copy(own.begin(), own.end(), values.begin() + n * k);
        }
        else if (const double *const sum = sums.data() + (n + 1) * k; sum[n] > 0.)
          for (unsigned int i = 0; i < n; ++i)
            values[n * k + i] = sum[i] / sum[n];
      return values;
    }

    /// Site values of all sites on a new mesh: those of slave nodes from @p vectors, those of integration points
    /// interpolated between them.
    std::vector<double> interpolated_sites(const std::vector<Vector> &vectors, const ContactSurfaces &surfaces)
    {
      const unsigned int  n = n_site_values(), n_slaves = surfaces.slave_nodes().size();
      std::vector<double> nodes(n * n_slaves, 0.);
      for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
        std::copy_n(numbers_of(vectors, surfaces, k).begin(), n, nodes.begin() + n * k);
      surfaces.slave_exchange().update(nodes, n);
      std::vector<double> sites(n * surfaces.n_sites(), 0.);
      for (unsigned int k = 0; k < n_slaves; ++k)
        if (surfaces.has_status(k)) // otherwise the points take it over
          std::copy_n(nodes.begin() + n * k, n, sites.begin() + n * k);
      for (unsigned int s = n_slaves; s < surfaces.n_sites(); ++s)
      {
        const SlavePoint  &point = surfaces.point(s);
        const SurfaceFace &face  = surfaces.slave_faces(point.pair)[point.face];
        const auto         shape = face.slave_values(FaceShape(surfaces.degree(), point.xi, point.eta).value);
        for (unsigned int a = 0; a < face.slaves.size(); ++a)
          for (unsigned int i = 0; i < n; ++i)
            sites[n * s + i] += shape[a] * nodes[n * face.slaves[a] + i];
      }
      return sites;
    }

    /// Reads or writes what all ranks share.
    template <typename Archive>
    struct CommonArchive : public Nothing
    {
      Archive &archive;
      template <typename T>
      void common(T &member)
      {
        archive &member;
      }
    };
  } // namespace

  unsigned int n_displacement_vectors()
  {
    return widths().node_vectors;
  }

  unsigned int n_site_values()
  {
    return widths().site;
  }

  unsigned int n_state_vectors(const ContactSurfaces &surfaces)
  {
    return n_displacement_vectors() + surfaces.n_layers() * vectors_of_layer();
  }

  std::vector<double> site_values(const State &state, const unsigned int site)
  {
    std::vector<double> values(n_site_values());
    SiteWriter          writer{{}, site, values.data()};
    visit_members(state, writer);
    return values;
  }

  std::vector<Vector> exact_vectors(const State &state, const ContactInterface &contact)
  {
    return as_vectors(state,
                      contact,
                      [&](const unsigned int k)
                      {
                        std::vector<double> values = site_values(state, k);
                        values.resize(n_slave_numbers(), 0.);
                        write_slave(state, contact.surfaces(), k, values.data() + n_site_values());
                        return values;
                      });
  }

  void take_exact(const std::vector<Vector> &vectors,
                  std::vector<double>        sites,
                  const ContactInterface    &contact,
                  State                     &state)
  {
    const ContactSurfaces &surfaces = contact.surfaces();
    set_nodes(vectors, state);
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
    {
      const std::vector<double> values = numbers_of(vectors, surfaces, k);
      std::copy_n(values.begin(), n_site_values(), sites.begin() + n_site_values() * k);
      SlaveReader reader{{}, k, surfaces.multiplier(k), values.data() + n_site_values()};
      visit_members(state, reader);
    }
    for (unsigned int b = 1; b < 3; ++b)
      state.unknowns.block(b).compress(dealii::VectorOperation::insert);
    set_sites(std::move(sites), surfaces, state);
  }

  std::vector<Vector> interpolable_vectors(const State &state, const ContactInterface &contact)
  {
    const ContactSurfaces    &surfaces = contact.surfaces();
    const unsigned int        n        = n_site_values();
    const std::vector<double> means    = node_values(state, contact);
    return as_vectors(state,
                      contact,
                      [&](const unsigned int k)
                      {
                        std::vector<double> values(n_slave_numbers(), 0.);
                        std::copy_n(means.begin() + n * k, n, values.begin());
                        write_slave(state, surfaces, k, values.data() + n);
                        Vector3 Lambda;
                        for (unsigned int i = 0; i < 2; ++i)
                          Lambda +=
                              state.unknowns.block(2)(2 * surfaces.multiplier(k) + i) * state.contact.tangents[k][i];
                        write(Lambda, values.data() + n + widths().slave);
                        return values;
                      });
  }

  void take_interpolated(const std::vector<Vector> &vectors, const ContactInterface &contact, State &state)
  {
    const ContactSurfaces    &surfaces = contact.surfaces();
    const unsigned int        n        = n_site_values();
    const std::vector<double> sites    = interpolated_sites(vectors, surfaces);
    take_exact(vectors, sites, contact, state);
    set_sites(sites, surfaces, state); // those without status stay empty

    Vector &Lambda = state.unknowns.block(2);
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
    {
      const std::vector<double> numbers  = numbers_of(vectors, surfaces, k);
      std::array<Vector3, 2>   &tangents = state.contact.tangents[k];
      Vector3                   in_space;
      read(numbers.data() + n + widths().slave, in_space);
      for (unsigned int i = 0; i < 2; ++i)
      {
        if (i == 1) // the tangents lie between those of other nodes
          tangents[1] -= (tangents[1] * tangents[0]) * tangents[0];
        if (const double norm = tangents[i].norm(); norm > 0.)
          tangents[i] /= norm;
        Lambda(2 * surfaces.multiplier(k) + i) = in_space * tangents[i];
      }
    }
    Lambda.compress(dealii::VectorOperation::insert);

    InterfaceState &interface = state.contact;
    interface.area.assign(interface.area.size(), 0.);
    interface.on_new_mesh     = true;
    const unsigned int closed = place_of(interface.statuses.contact, state);
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s) // between closed ones alone, which have a partner
      interface.stuck[s] = std::abs(sites[n * s + closed] - 1.) < 1e-6;
  }

  KeptState::KeptState(const State &state, const ContactInterface &contact)
  {
    const ContactSurfaces &surfaces = contact.surfaces();
    NodeVectors            vectors;
    visit_members(state, vectors);
    for (const Vector *const v : vectors.vectors)
      of_nodes_.push_back(*v);
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s))
      {
        std::vector<double> &numbers = of_sites_[{surfaces.is_point(s), surfaces.order(s)}] = site_values(state, s);
        if (surfaces.is_point(s))
          continue;
        numbers.resize(n_site_values() + widths().slave);
        write_slave(state, surfaces, s, numbers.data() + n_site_values());
      }
  }

  void KeptState::restore(const ContactInterface &contact, State &state) const
  {
    const ContactSurfaces &surfaces = contact.surfaces();
    set_nodes(of_nodes_, state);
    std::vector<double> sites(n_site_values() * surfaces.n_sites(), 0.);
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const auto kept =
          surfaces.is_owned(s) ? of_sites_.find({surfaces.is_point(s), surfaces.order(s)}) : of_sites_.end();
      const std::vector<double> numbers = kept == of_sites_.end() ? site_values(state, s) : kept->second;
      std::copy_n(numbers.begin(), n_site_values(), sites.begin() + n_site_values() * s);
      if (numbers.size() == n_site_values())
        continue;
      SlaveReader reader{{}, s, surfaces.multiplier(s), numbers.data() + n_site_values()};
      visit_members(state, reader);
    }
    for (unsigned int b = 1; b < 3; ++b)
      state.unknowns.block(b).compress(dealii::VectorOperation::insert);
    set_sites(std::move(sites), surfaces, state);
  }

  std::vector<char> pack_common(const State &state)
  {
    std::ostringstream                             stream(std::ios::binary);
    boost::archive::binary_oarchive                archive(stream);
    CommonArchive<boost::archive::binary_oarchive> writer{{}, archive};
    visit_members(state, writer);
    const std::string bytes = stream.str();
    return {bytes.begin(), bytes.end()};
  }

  void unpack_common(const std::vector<char> &bytes, State &state)
  {
    std::istringstream                             stream(std::string(bytes.begin(), bytes.end()), std::ios::binary);
    boost::archive::binary_iarchive                archive(stream);
    CommonArchive<boost::archive::binary_iarchive> reader{{}, archive};
    visit_members(state, reader);
  }

  void copy_common(const State &from, State &to)
  {
    unpack_common(pack_common(from), to);
  }
} // namespace Nodus
