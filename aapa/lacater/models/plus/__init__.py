"""`aapa-plus`: anchoring the snitch with geometry, and knowing what moves and what rests.

`ideas` lists what can be switched off, `tracker` puts it all together. `solids`, `ground` and
`calibration` are the floor as the camera sees it; `things` remembers what was seen of each object
and averages at rest, `paths` follows one move to its end, `hiding` bounds what goes on unseen,
`standing` and `carrying` are the child in its container, `appearance` how large it looks.
`suspicion` infers that there is a container, from what `containment` measures, with the `rivals`
weighed; `reasons` puts what is believed into words.

What it takes for granted, beyond what AAPA does: what size CATER's classes are, its lens and how
its things speed up and slow down. It does not know where the camera is, it finds that out.
"""

from __future__ import annotations

from aapa.lacater.models.plus.ideas import Ideas
from aapa.lacater.models.plus.tracker import BeyondAapa

__all__ = ["BeyondAapa", "Ideas"]
