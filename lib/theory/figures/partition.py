"""Partition of the equations of a cluster, before and after the choice of rows and columns."""
from matplotlib.patches import Rectangle

from drawing import BLUE, GREEN, GREY, INK, LIGHT, RED, arrow, save, sketch

figure, axes = sketch(7.2, 2.9)
rows, columns, rank, size = 5, 9, 4, 0.3


def block(left, top, width, height, colour, text="", alpha=0.25):
    axes.add_patch(Rectangle((left, top - height), width, height, fc=colour, ec=INK, lw=0.9, alpha=alpha))
    axes.add_patch(Rectangle((left, top - height), width, height, fc="none", ec=INK, lw=0.9))
    axes.text(left + width / 2, top - height / 2, text, ha="center", va="center")


# the matrix as it stands: two nodes of a joint in each row
entries = ((0, range(0, 4)), (1, range(0, 4)), (2, range(2, 7)), (3, range(5, 9)), (4, range(5, 9)))
for row, used in entries:
    for column in range(columns):
        axes.add_patch(Rectangle((size * column, 2.2 - size * (row + 1)), size, size, ec=LIGHT, lw=0.6,
                                 fc=GREY if column in used else "white", alpha=0.6))
axes.add_patch(Rectangle((0, 2.2 - size * rows), size * columns, size * rows, fc="none", ec=INK, lw=0.9))
axes.text(size * columns / 2, 2.42, "$B$, by constraints and nodes", ha="center")
arrow(axes, (2.95, 1.45), (3.75, 1.45))
axes.text(3.35, 1.72, "complete\npivoting", ha="center", fontsize=8, color=GREY)

left, top = 4.0, 2.2
block(left, top, size * rank, size * rank, BLUE, "$C_d$")
block(left + size * rank, top, size * (columns - rank), size * rank, GREEN, "$C_i$")
block(left, top - size * rank, size * columns, size * (rows - rank), RED, "redundant: $X(C_d,\\,C_i)$", 0.18)
axes.text(left + size * rank / 2, top + 0.22, "dependent", ha="center", color=BLUE)
axes.text(left + size * (rank + columns) / 2, top + 0.22, "independent", ha="center", color=GREEN)
axes.text(left + size * columns + 0.1, top - size * rank / 2, "pivot rows", ha="left", va="center", color=GREY)

axes.text(left, 0.3, r"$x_d=G\,x_i,\quad G=-C_d^{-1}C_i$", ha="left")
axes.text(0.0, 0.3,
          r"$\mathcal{R}=(G;\,I),\quad B\,\mathcal{R}=0,\quad\mathcal{R}^{T}S_c\,\mathcal{R}\,y=-\mathcal{R}^{T}r$",
          ha="left")
axes.set_xlim(-0.1, 7.9)
axes.set_ylim(0.05, 2.7)
save(figure)
