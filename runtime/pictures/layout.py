"""Where each picture stands when the viewer opens."""

from __future__ import annotations

import rerun.blueprint as rrb


def layout(*, has_camera: bool) -> rrb.Blueprint:
    """Give the layout: camera and cell above, what is believed and done below.

    Args:
        has_camera: Whether the run has anchors and an arm to show.
    """
    timelines = rrb.Vertical(
        rrb.StateTimelineView(origin="doing", name="What it does, and its goals"),
        rrb.StateTimelineView(origin="beliefs", name="Beliefs that changed"),
        row_shares=[2, 5],
    )
    words = rrb.Vertical(
        rrb.TextDocumentView(origin="now", name="This cycle"),
        rrb.TextLogView(origin="log", name="Log"),
        row_shares=[1, 1],
    )
    hierarchy = rrb.GraphView(origin="hierarchy", name="Who moves with whom")
    below = rrb.Horizontal(timelines, words, column_shares=[3, 2])
    if not has_camera:
        return rrb.Blueprint(rrb.Vertical(hierarchy, below), collapse_panels=True)
    above = rrb.Horizontal(
        rrb.Spatial2DView(origin="camera", name="Camera: detections and anchors"),
        rrb.Spatial3DView(origin="cell", name="Cell"),
        hierarchy,
        column_shares=[3, 4, 2],
    )
    return rrb.Blueprint(rrb.Vertical(above, below, row_shares=[1, 1]), collapse_panels=True)
