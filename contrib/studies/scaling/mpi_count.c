/* Counts the messages of a program and the CPU time that it spends in MPI: a library to be preloaded (ranks.py does).
   At the end each rank writes <MPI_COUNT>.<rank> with lines "name value". Point-to-point of collectives is not seen. */
#define _GNU_SOURCE
#include <mpi.h>

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

enum { n_kinds = 4 };
static const char *const kinds[n_kinds] = {"messages", "reductions", "gathers", "other collectives"};
static double calls[n_kinds], bytes[n_kinds], cpu;
static char   partner[1 << 16];

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void count(const int kind, const int n, MPI_Datatype type, const int destination)
{
  int size = 0;
  PMPI_Type_size(type, &size);
  ++calls[kind];
  bytes[kind] += (double)n * size;
  if (destination >= 0 && destination < (int)sizeof(partner))
    partner[destination] = 1;
}

#define TIMED(call)             \
  const double start  = now();  \
  const int    result = (call); \
  cpu += now() - start;         \
  return result;

#define SEND(name)                                                                                        \
  int MPI_##name(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c)                       \
  {                                                                                                       \
    count(0, n, t, to);                                                                                   \
    TIMED(PMPI_##name(b, n, t, to, tag, c))                                                               \
  }
#define ISEND(name)                                                                                       \
  int MPI_##name(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r)       \
  {                                                                                                       \
    count(0, n, t, to);                                                                                   \
    TIMED(PMPI_##name(b, n, t, to, tag, c, r))                                                            \
  }
SEND(Send)
SEND(Ssend)
SEND(Rsend)
ISEND(Isend)
ISEND(Issend)
ISEND(Irsend)

int MPI_Recv(void *b, int n, MPI_Datatype t, int from, int tag, MPI_Comm c, MPI_Status *s)
{
  TIMED(PMPI_Recv(b, n, t, from, tag, c, s))
}
int MPI_Irecv(void *b, int n, MPI_Datatype t, int from, int tag, MPI_Comm c, MPI_Request *r)
{
  TIMED(PMPI_Irecv(b, n, t, from, tag, c, r))
}
int MPI_Probe(int from, int tag, MPI_Comm c, MPI_Status *s)
{
  TIMED(PMPI_Probe(from, tag, c, s))
}
int MPI_Iprobe(int from, int tag, MPI_Comm c, int *flag, MPI_Status *s)
{
  TIMED(PMPI_Iprobe(from, tag, c, flag, s))
}
int MPI_Wait(MPI_Request *r, MPI_Status *s)
{
  TIMED(PMPI_Wait(r, s))
}
int MPI_Waitall(int n, MPI_Request *r, MPI_Status *s)
{
  TIMED(PMPI_Waitall(n, r, s))
}
int MPI_Waitany(int n, MPI_Request *r, int *i, MPI_Status *s)
{
  TIMED(PMPI_Waitany(n, r, i, s))
}
int MPI_Test(MPI_Request *r, int *flag, MPI_Status *s)
{
  TIMED(PMPI_Test(r, flag, s))
}
int MPI_Testall(int n, MPI_Request *r, int *flag, MPI_Status *s)
{
  TIMED(PMPI_Testall(n, r, flag, s))
}
int MPI_Sendrecv(const void *b, int n, MPI_Datatype t, int to, int tag, void *b2, int n2, MPI_Datatype t2, int from,
                 int tag2, MPI_Comm c, MPI_Status *s)
{
  count(0, n, t, to);
  TIMED(PMPI_Sendrecv(b, n, t, to, tag, b2, n2, t2, from, tag2, c, s))
}
int MPI_Barrier(MPI_Comm c)
{
  count(3, 0, MPI_BYTE, -1);
  TIMED(PMPI_Barrier(c))
}
int MPI_Ibarrier(MPI_Comm c, MPI_Request *r)
{
  count(3, 0, MPI_BYTE, -1);
  TIMED(PMPI_Ibarrier(c, r))
}
int MPI_Bcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm c)
{
  count(3, n, t, -1);
  TIMED(PMPI_Bcast(b, n, t, root, c))
}
int MPI_Allreduce(const void *b, void *b2, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
{
  count(1, n, t, -1);
  TIMED(PMPI_Allreduce(b, b2, n, t, o, c))
}
int MPI_Reduce(const void *b, void *b2, int n, MPI_Datatype t, MPI_Op o, int root, MPI_Comm c)
{
  count(1, n, t, -1);
  TIMED(PMPI_Reduce(b, b2, n, t, o, root, c))
}
int MPI_Scan(const void *b, void *b2, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
{
  count(1, n, t, -1);
  TIMED(PMPI_Scan(b, b2, n, t, o, c))
}
int MPI_Exscan(const void *b, void *b2, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
{
  count(1, n, t, -1);
  TIMED(PMPI_Exscan(b, b2, n, t, o, c))
}
int MPI_Reduce_scatter(const void *b, void *b2, const int *n, MPI_Datatype t, MPI_Op o, MPI_Comm c)
{
  count(1, n[0], t, -1);
  TIMED(PMPI_Reduce_scatter(b, b2, n, t, o, c))
}
int MPI_Allgather(const void *b, int n, MPI_Datatype t, void *b2, int n2, MPI_Datatype t2, MPI_Comm c)
{
  count(2, n, t, -1);
  TIMED(PMPI_Allgather(b, n, t, b2, n2, t2, c))
}
int MPI_Allgatherv(const void *b, int n, MPI_Datatype t, void *b2, const int *n2, const int *d, MPI_Datatype t2, MPI_Comm c)
{
  count(2, n, t, -1);
  TIMED(PMPI_Allgatherv(b, n, t, b2, n2, d, t2, c))
}
int MPI_Gather(const void *b, int n, MPI_Datatype t, void *b2, int n2, MPI_Datatype t2, int root, MPI_Comm c)
{
  count(2, n, t, -1);
  TIMED(PMPI_Gather(b, n, t, b2, n2, t2, root, c))
}
int MPI_Gatherv(const void *b, int n, MPI_Datatype t, void *b2, const int *n2, const int *d, MPI_Datatype t2, int root, MPI_Comm c)
{
  count(2, n, t, -1);
  TIMED(PMPI_Gatherv(b, n, t, b2, n2, d, t2, root, c))
}
int MPI_Alltoall(const void *b, int n, MPI_Datatype t, void *b2, int n2, MPI_Datatype t2, MPI_Comm c)
{
  count(3, n, t, -1);
  TIMED(PMPI_Alltoall(b, n, t, b2, n2, t2, c))
}

int MPI_Alltoallv(const void *b, const int *n, const int *d, MPI_Datatype t, void *b2, const int *n2, const int *d2, MPI_Datatype t2, MPI_Comm c)
{
  count(3, 0, t, -1);
  TIMED(PMPI_Alltoallv(b, n, d, t, b2, n2, d2, t2, c))
}
int MPI_Comm_dup(MPI_Comm c, MPI_Comm *c2)
{
  count(3, 0, MPI_BYTE, -1);
  TIMED(PMPI_Comm_dup(c, c2))
}
int MPI_Comm_split(MPI_Comm c, int colour, int key, MPI_Comm *c2)
{
  count(3, 0, MPI_BYTE, -1);
  TIMED(PMPI_Comm_split(c, colour, key, c2))
}
int MPI_Comm_create(MPI_Comm c, MPI_Group g, MPI_Comm *c2)
{
  count(3, 0, MPI_BYTE, -1);
  TIMED(PMPI_Comm_create(c, g, c2))
}
int MPI_Comm_free(MPI_Comm *c)
{
  TIMED(PMPI_Comm_free(c))
}
int MPI_Waitsome(int n, MPI_Request *r, int *m, int *i, MPI_Status *s)
{
  TIMED(PMPI_Waitsome(n, r, m, i, s))
}
int MPI_Testany(int n, MPI_Request *r, int *i, int *flag, MPI_Status *s)
{
  TIMED(PMPI_Testany(n, r, i, flag, s))
}
int MPI_Mprobe(int from, int tag, MPI_Comm c, MPI_Message *m, MPI_Status *s)
{
  TIMED(PMPI_Mprobe(from, tag, c, m, s))
}

int MPI_Finalize(void)
{
  int               rank, partners = 0;
  const char *const name = getenv("MPI_COUNT");
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (unsigned int i = 0; i < sizeof(partner); ++i)
    partners += partner[i];
  char path[4096];
  snprintf(path, sizeof(path), "%s.%d", name ? name : "mpi_count", rank);
  FILE *const file = fopen(path, "w");
  if (file)
  {
    for (int k = 0; k < n_kinds; ++k)
      fprintf(file, "%s %.0f\n%s bytes %.0f\n", kinds[k], calls[k], kinds[k], bytes[k]);
    fprintf(file, "partners %d\ncpu %.6f\n", partners, cpu);
    struct timespec process;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &process);
    fprintf(file, "process cpu %.6f\n", process.tv_sec + 1e-9 * process.tv_nsec);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    fprintf(file, "peak %.0f\n", 1024. * usage.ru_maxrss);
    fclose(file);
  }
  return PMPI_Finalize();
}
