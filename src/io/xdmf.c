/* particles.xdmf and grid.xdmf: the time series of either over the files of the snapshots, for ParaView's and VisIt's
   XDMF readers. Two files, for the readers hide one series behind the other, and snapshots without nodal fields, when
   they share one. The particles name their vertices, for XDMF 3 makes no points of bare coordinates; the grid is one
   layer of a 3-D mesh, for VTK's reader lays a 2DCoRectMesh into the y-z plane. */
#include "io_private.h"

const char *const xdmf_name[] = {[XDMF_PARTICLES] = "particles", [XDMF_GRID] = "grid"};

static void Item(FILE *f, const char *dims, bool integer, const char *kind, PetscInt number, const char *name)
{
  fprintf(f,
          "<DataItem Dimensions=\"%s\" NumberType=\"%s\" Precision=\"%d\" Format=\"HDF\">" SNAPSHOT_NAME
          ":/%s/%s</DataItem>",
          dims, integer ? "Int" : "Float", (int)(integer ? sizeof(PetscInt) : sizeof(double)), (int)number, kind, name);
}

/* The XDMF types of vectors and tensors are three-dimensional; two and six components go as a matrix. */
static void Attribute(FILE *f, const char *points, int nc, bool integer, const char *kind, PetscInt number,
                      const char *name)
{
  char dims[96];

  snprintf(dims, sizeof(dims), nc > 1 ? "%s %d" : "%s", points, nc);
  fprintf(f, "        <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">", name,
          nc > 1 ? "Matrix" : "Scalar");
  Item(f, dims, integer, kind, number, name);
  fprintf(f, "</Attribute>\n");
}

static void ParticleGrid(FILE *f, const FieldSet *fs, const SnapshotEntry *e)
{
  char n[32], places[48];

  snprintf(n, sizeof(n), "%d", (int)e->n);
  snprintf(places, sizeof(places), "%s %d", n, CL_DIM);
  fprintf(f, "      <Grid Name=\"particles_%06d\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n",
          (int)e->number, e->t);
  fprintf(f, "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%s\" NodesPerElement=\"1\">", n);
  Item(f, n, true, "particles", e->number, io_whole[WHOLE_VERTEX]);
  fprintf(f, "</Topology>\n        <Geometry GeometryType=\"%s\">", CL_DIM == 2 ? "XY" : "XYZ");
  Item(f, places, false, "particles", e->number, "position");
  fprintf(f, "</Geometry>\n");
  for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
    if (v->first != P_X && (fs->has & v->has))
      Attribute(f, n, v->nc, false, "particles", e->number, v->name);
  }
  for (const DerivedQuantity *v = io_derived; v->name; v++) {
    if (v->snapshots && (fs->has & v->has))
      Attribute(f, n, 1, false, "particles", e->number, v->name);
  }
  for (int k = 0; k < WHOLE_COUNT; k++) {
    if (k != WHOLE_VERTEX)
      Attribute(f, n, 1, true, "particles", e->number, io_whole[k]);
  }
  fprintf(f, "      </Grid>\n");
}

/* Three numbers, z y x, of which the plane has no first. */
static void Three(FILE *f, double none, const double v[CL_DIM])
{
  fprintf(f, "<DataItem Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">");
  for (int d = 2; d >= 0; d--)
    fprintf(f, d ? "%.17g " : "%.17g</DataItem>", d < CL_DIM ? v[d < CL_DIM ? d : 0] : none);
}

static void Equal(FILE *f, const Grid *g, const char *n)
{
  double h[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    h[d] = g->line[d].h;
  fprintf(f, "        <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"%s\"/>\n", n);
  fprintf(f, "        <Geometry GeometryType=\"ORIGIN_DXDYDZ\">");
  Three(f, 0.0, g->lower);
  fprintf(f, "\n");
  Three(f, 1.0, h);
  fprintf(f, "</Geometry>\n");
}

/* Places of the lines, x, y and z, or the one layer. */
static void Lines(FILE *f, const Grid *g, const char *n)
{
  fprintf(f, "        <Topology TopologyType=\"3DRectMesh\" Dimensions=\"%s\"/>\n", n);
  fprintf(f, "        <Geometry GeometryType=\"VXVYVZ\">");
  for (int d = 0; d < 3; d++) {
    const PetscInt cells = d < CL_DIM ? g->cells[d < CL_DIM ? d : 0] : 0;

    fprintf(f, "<DataItem Dimensions=\"%d\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">", (int)cells + 1);
    for (PetscInt i = 0; i <= cells; i++)
      fprintf(f, "%s%.17g", i ? " " : "", d < CL_DIM ? GridNode(g, d < CL_DIM ? d : 0, i) : 0.0);
    fprintf(f, "</DataItem>");
  }
  fprintf(f, "</Geometry>\n");
}

static void NodeGrid(FILE *f, const FieldSet *fs, const Grid *g, const SnapshotEntry *e)
{
  char n[64];
  bool unequal = false;

  for (int d = 0; d < CL_DIM; d++)
    unequal = unequal || g->line[d].x;
  snprintf(n, sizeof(n), "%d %d %d", CL_DIM == 2 ? 1 : (int)g->cells[CL_DIM - 1] + 1, (int)g->cells[1] + 1,
           (int)g->cells[0] + 1);
  fprintf(f, "      <Grid Name=\"grid_%06d\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n", (int)e->number,
          e->t);
  if (unequal)
    Lines(f, g, n);
  else
    Equal(f, g, n);
  for (const NodalVariable *v = io_nodal; v->name; v++) {
    if (fs->at[v->first] >= 0)
      Attribute(f, n, v->nc, false, "grid", e->number, v->name);
  }
  fprintf(f, "      </Grid>\n");
}

void XdmfPrint(FILE *f, const Output *out, const Grid *g, XdmfKind kind)
{
  fprintf(f, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n");
  fprintf(f, "    <Grid Name=\"%s\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", xdmf_name[kind]);
  for (PetscInt k = 0; k < out->nsnapshot; k++) {
    if (kind == XDMF_PARTICLES)
      ParticleGrid(f, &out->fields, &out->snapshot[k]);
    else if (out->snapshot[k].grid)
      NodeGrid(f, &out->fields, g, &out->snapshot[k]);
  }
  fprintf(f, "    </Grid>\n  </Domain>\n</Xdmf>\n");
}
