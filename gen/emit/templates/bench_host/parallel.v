    // The bus: the bus of a signal processor. Strobes are longer than they have to be, and belong to no clock.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    localparam real STROBE_NS = 6.3 * CLK_NS;
    reg bus_cs_n, bus_rd_n, bus_wr_n;
    reg [2:0] bus_address;
    reg [15:0] bus_data_to_card;
    wire [15:0] bus_data_from_card;
    wire bus_data_oe;
    reg [15:0] half;

    task host_idle;
        begin
            bus_cs_n = 1'b1;
            bus_rd_n = 1'b1;
            bus_wr_n = 1'b1;
            bus_address = 3'd0;
            bus_data_to_card = 16'd0;
        end
    endtask

    task read_half(input [2:0] at);
        begin
            bus_address = at;
            bus_cs_n = 1'b0;
            bus_rd_n = 1'b0;
            #(STROBE_NS);
            check("bus_data_oe in a read", {47'd0, bus_data_oe}, 48'd1);
            half = bus_data_from_card;
            host_idle;
            #(STROBE_NS);
            check("bus_data_oe after a read", {47'd0, bus_data_oe}, 48'd0);
        end
    endtask

    task write_half(input [2:0] at, input [15:0] value);
        begin
            bus_address = at;
            bus_data_to_card = value;
            bus_cs_n = 1'b0;
            #(CLK_NS);
            bus_wr_n = 1'b0;
            #(STROBE_NS);
            bus_wr_n = 1'b1;
            #(CLK_NS);
            host_idle;
            #(STROBE_NS);
        end
    endtask

    // Register 5: window, busy in bit 15, write without reading first in bit 14. Registers 6 and 7: the word.
    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            write_half(3'd5, {1'b0, write, 3'd0, address[10:0]});
            if (write) begin
                write_half(3'd6, value[15:0]);
                write_half(3'd7, value[31:16]);
            end
            half = 16'h8000;
            for (k = 0; k < ACCESS_CYCLES_MAX && half[15]; k = k + 1)
                read_half(3'd5);
            check("window is free", {47'd0, half[15]}, 48'd0);
            if (!write) begin
                read_half(3'd7);
                answer[31:16] = half;
                read_half(3'd6);
                answer[15:0] = half;
            end
        end
    endtask

    // Strobes without select, halves of a word in either order, a word that is read again; at the word that is free for the host.
    task bus_limits;
        begin
            transfer(1'b1, CARD_CONFIG_HOLD, 32'hA1B2C300);
            // Another chip's write.
            bus_address = 3'd5;
            bus_data_to_card = 16'h4000 | CARD_CONFIG_HOLD[10:0];
            #(CLK_NS);
            bus_wr_n = 1'b0;
            #(STROBE_NS);
            bus_wr_n = 1'b1;
            #(CLK_NS);
            bus_address = 3'd7;
            bus_data_to_card = 16'hFFFF;
            #(CLK_NS);
            bus_wr_n = 1'b0;
            #(STROBE_NS);
            bus_wr_n = 1'b1;
            host_idle;
            #(SETTLE_NS);
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after another chip's write", answer, 32'hA1B2C300);
            read_half(3'd6);
            check("low half, once more", half, 16'hC300);
            read_half(3'd7);
            check("high half, once more", half, 16'hA1B2);
            transfer(1'b1, CARD_CONFIG_HOLD, 32'h4D5E6F00);
            transfer(1'b1, CARD_CONFIG_TRIGGER_PERIOD, 32'h00345678);
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word of the first of two writes", answer, 32'h4D5E6F00);
            transfer(1'b0, CARD_CONFIG_TRIGGER_PERIOD, 32'd0);
            check("word of the second of two writes", answer, 32'h00345678);
            transfer(1'b1, CARD_CONFIG_HOLD, 32'd0);
        end
    endtask
