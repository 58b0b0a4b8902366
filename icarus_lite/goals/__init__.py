"""Goals: which of several an agent pursues now, and which it sets aside, keeps up or drops."""

from icarus_lite.goals.agenda import Agenda
from icarus_lite.goals.goal import Goal, name_of
from icarus_lite.goals.management import SWITCHING_MARGIN, Management
from icarus_lite.goals.nomination import Nominator

__all__ = ["SWITCHING_MARGIN", "Agenda", "Goal", "Management", "Nominator", "name_of"]
