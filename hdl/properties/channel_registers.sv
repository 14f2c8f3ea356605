// held_together: All held words of a result change in the cycle in which they are loaded, and in no other one.
// age_while_shown: Age and `stale` of the held result advance only while nothing is read.
// age_saturates: The age of the held result counts microseconds up to 65535, and stays there.
// settings_stay: Settings change only while the channel is not busy, and not in the cycle of a trigger.
// owed_once: A channel owes one result for a trigger that it accepts, until that result comes.
reg f_past_valid; initial f_past_valid = 1'b0;
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset)) begin
        if ($past(!load)) held_together: assert ($stable({held_0, held_1, held_2, held_3, held_4, held_5}));
        if ($past(!show)) age_while_shown: assert ($stable({age_shown, stale_shown}));
        if ($past(busy | trigger)) settings_stay: assert ($stable({config0, config1, config2}));
        if ($past(!load)) age_saturates: assert (age == $past(age) + {15'd0, $past(tick_us & (age != 16'hffff))});
        if ($past(result_strobe & !new_set)) owed_once: assert (!waiting);
        if ($past(!result_strobe & !new_set)) owed_once_kept: assert ($stable(waiting));
        if ($past(new_set)) owed_once_taken: assert (waiting == $past(trigger & !busy));
    end
end
